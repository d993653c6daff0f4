// References along the Morton curve.
#pragma once

#include <span>

#include "boxwood/base.h"
#include "boxwood/parallel.h"
#include "boxwood/refs.h"
#include "parallel/radix_sort.h"

namespace boxwood::builders {

/// The references' numbers, sorted by the Morton codes of their centroids on a grid of 2^bits_per_axis cells a side
/// over the box of the centroids; equal codes keep the references' order. Not empty; bits_per_axis 1 to 21.
AlignedBuffer<KeyedIndex> morton_order(std::span<const refs::Reference> references, int bits_per_axis,
                                       Executor& executor);

}  // namespace boxwood::builders
