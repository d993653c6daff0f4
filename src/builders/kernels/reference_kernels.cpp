// Boxes are worked on as Box8: with eight lanes to a register each is loaded, grown and stored at once. Beyond eight
// lanes there is nothing to gain.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "builders/kernels/reference_kernels.cpp"
#ifndef BOXWOOD_FEW_TARGETS
#define BOXWOOD_FEW_TARGETS
#endif
#include "base/simd_targets.h"
// clang-format off
#include <hwy/foreach_target.h>
// clang-format on
#include "builders/kernels/box8-inl.h"
#include "builders/kernels/reference_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::builders::HWY_NAMESPACE {

using refs::Reference;

/// The fourth lanes of references hold ids; as denormal numbers these would be very slow to calculate with.
HWY_INLINE Box8 xyz_xyz() {
  return Box8::of(xyz_mask(), xyz_mask());
}

// ---- Binning -------------------------------------------------------------------------------------------------------

struct PlacedBox {
  Box8 box;
  alignas(16) std::uint32_t bin[4];
};

HWY_INLINE PlacedBox place(const BinGrid& grid, const Reference& reference) {
  PlacedBox placed;
  placed.box = (Box8::load(&reference) & xyz_xyz()) ^ upper_signs();
  ((placed.box.low() - placed.box.high() - grid.origin) * grid.scale).store_integers(placed.bin);
  return placed;
}

HWY_INLINE void put(const PlacedBox& placed, int axis, BinTable& table) {
  const std::uint32_t bin = placed.bin[axis];
  Box8 box = Box8::load(table.boxes[bin].axis[axis]);
  box.grow(placed.box);
  box.store(table.boxes[bin].axis[axis]);
  ++table.counts[bin].axis[axis];
}

/// Fewer references are not worth four places at once.
constexpr std::size_t kWorthQuarters = 16;

void bin(const BinGrid& grid_of_caller, const Reference* references, std::size_t count, BinTable& table) {
  // Neighbours in memory are mostly neighbours in space: one after the other they would wait for each other's bins.
  // So the four quarters of the references are walked side by side, and the halves of a few.
  const BinGrid grid = grid_of_caller;  // a copy stays in registers
  const std::size_t quarter = count < kWorthQuarters ? 0 : count / 4;
  for (std::size_t i = 0; i < quarter; ++i) {
    const PlacedBox a = place(grid, references[i]), b = place(grid, references[i + quarter]),
                    c = place(grid, references[i + 2 * quarter]), d = place(grid, references[i + 3 * quarter]);
    for (int axis = 0; axis < 3; ++axis)
      put(a, axis, table), put(b, axis, table), put(c, axis, table), put(d, axis, table);
  }
  references += 4 * quarter;
  count -= 4 * quarter;
  const std::size_t half = count / 2;
  for (std::size_t i = 0; i < half; ++i) {
    const PlacedBox a = place(grid, references[i]), b = place(grid, references[i + half]);
    for (int axis = 0; axis < 3; ++axis) put(a, axis, table), put(b, axis, table);
  }
  if (count % 2 == 0) return;
  const PlacedBox last = place(grid, references[count - 1]);
  for (int axis = 0; axis < 3; ++axis) put(last, axis, table);
}

// ---- The best split between bins -----------------------------------------------------------------------------------

/// The union of bins on each axis, one bin after the other.
struct GrownBins {
  Box8 box[3];
  Float4 number;

  // Not a constructor or an initialiser: the compiler would make those for the baseline.
  static HWY_INLINE GrownBins none() { return {{Box8::empty(), Box8::empty(), Box8::empty()}, Float4::fill(0)}; }
  HWY_INLINE void add(const BinTable& table, int bin) {
    for (int axis = 0; axis < 3; ++axis) box[axis].grow(Box8::load(table.boxes[bin].axis[axis]));
    number = number + Float4::load_integers(table.counts[bin].axis);
  }
  /// Half area times number, an axis a lane. Extents are negative here, which their products are not.
  HWY_INLINE Float4 cost(Float4 scale) const {
    return half_areas((box[0].low() + box[0].high()) * scale, (box[1].low() + box[1].high()) * scale,
                      (box[2].low() + box[2].high()) * scale) *
           number;
  }
};

BinSplit best_split(const BinGrid& grid, const BinTable& table, float area_scale) {
  const Float4 scale = Float4::fill(area_scale);
  Float4 right_cost[kMostBins];  // of bins i and up
  GrownBins right = GrownBins::none();
  for (int i = table.count - 1; i > 0; --i) {
    right.add(table, i);
    right_cost[i] = right.cost(scale);
  }
  GrownBins left = GrownBins::none();
  Float4 best_cost = Float4::fill(kInfinity), best_bin = Float4::fill(0);
  for (int i = 1; i < table.count; ++i) {
    left.add(table, i - 1);
    const Float4 cost = left.cost(scale) + right_cost[i];
    const Float4 better = less(cost, best_cost);
    best_cost = select(better, cost, best_cost);
    best_bin = select(better, Float4::fill(static_cast<float>(i)), best_bin);
  }

  alignas(16) float costs[4], bins[4];
  best_cost.store(costs);
  best_bin.store(bins);
  BinSplit split;
  for (int axis = 0; axis < 3; ++axis) {
    if (!grid.usable[axis] || !(costs[axis] < split.cost)) continue;
    split.axis = axis;
    split.cost = costs[axis];
  }
  if (split.axis < 0) return split;
  split.bin = static_cast<int>(bins[split.axis]);
  Box8 left_box = Box8::empty(), right_box = Box8::empty();
  for (int i = 0; i < split.bin; ++i) {
    left_box.grow(Box8::load(table.boxes[i].axis[split.axis]));
    split.left_count += table.counts[i].axis[split.axis];
  }
  for (int i = split.bin; i < table.count; ++i) right_box.grow(Box8::load(table.boxes[i].axis[split.axis]));
  split.left = as_box4(left_box);
  split.right = as_box4(right_box);
  return split;
}

// ---- Partitioning --------------------------------------------------------------------------------------------------

alignas(32) constexpr std::uint32_t kIgnore[2][8] = {{}, {~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u, ~0u}};

/// The masks turn what belongs to the other side into NaN, which a minimum passes over: both sides are measured without
/// a branch.
template <bool kBounds>
HWY_INLINE ReferenceSides part_with(const RangeSplit& split, const Reference* source, std::size_t count,
                                    Reference* left, Reference* right) {
  const Float4 mask = xyz_mask();
  const Box8 signs = upper_signs();
  const int axis = split.axis;
  const float origin = split.origin, scale = split.scale, threshold = split.threshold;
  Reference* const base = left;
  std::ptrdiff_t next_left = 0, next_right = right - left;
  Box8 left_centroids = Box8::empty(), right_centroids = Box8::empty();
  Box8 left_bounds = Box8::empty(), right_bounds = Box8::empty();
  for (std::size_t i = 0; i < count; ++i) {
    const Box8 reference = Box8::load(source + i);
    const float* const lower = &source[i].lower.x;
    const bool is_left = (lower[axis] + lower[axis + 4] - origin) * scale < threshold;
    reference.store(base + (is_left ? next_left : next_right));
    next_left += is_left;
    next_right += !is_left;
    const Float4 sum = centroid2({reference.low(), reference.high()}, mask);
    const Box8 centroid = Box8::of(sum, sum) ^ signs;
    const Box8 not_left = Box8::load(kIgnore[!is_left]), not_right = Box8::load(kIgnore[is_left]);
    left_centroids.grow(centroid | not_left);
    right_centroids.grow(centroid | not_right);
    if constexpr (kBounds) {
      const Box8 box = reference ^ signs;
      left_bounds.grow(box | not_left);
      right_bounds.grow(box | not_right);
    }
  }
  return {{as_box4(left_bounds), as_box4(left_centroids)}, {as_box4(right_bounds), as_box4(right_centroids)}};
}

ReferenceSides part(const RangeSplit& split, const Reference* source, std::size_t count, Reference* left,
                    Reference* right) {
  return split.has_boxes ? part_with<false>(split, source, count, left, right)
                         : part_with<true>(split, source, count, left, right);
}

// ---- Morton codes --------------------------------------------------------------------------------------------------

#if HWY_ARCH_X86 && HWY_MAX_BYTES >= 32

/// A lane for each axis, the fourth of which is zero.
class Coder {
 public:
  HWY_INLINE explicit Coder(const MortonGrid& grid) {
    alignas(32) const double lower[] = {grid.lower(0), grid.lower(1), grid.lower(2), 0},
                             scale[] = {grid.scale(0), grid.scale(1), grid.scale(2), 0};
    alignas(32) constexpr std::uint64_t kPlaces[] = {2, 1, 0, 0};
    lower_ = hn::Load(Doubles(), lower);
    scale_ = hn::Load(Doubles(), scale);
    last_cell_ = hn::Set(Doubles(), grid.last_cell());
    places_ = hn::Load(Words(), kPlaces);
  }
  HWY_INLINE std::uint64_t code(const Reference& reference) const {
    const Float4 centroid = centroid2(Box4::of(reference), xyz_mask());
    const auto position =
        hn::Mul(hn::Sub(hn::PromoteTo(Doubles(), hn::Vec<hn::FixedTag<float, 4>>{centroid.v}), lower_), scale_);
    const auto inside = hn::Min(hn::Max(position, hn::Zero(Doubles())), last_cell_);
    const auto cell = hn::DemoteTo(hn::FixedTag<std::int32_t, 4>(), inside);
    auto x = hn::PromoteTo(Words(), hn::BitCast(hn::FixedTag<std::uint32_t, 4>(), cell));
    x = spread<32>(x, kSpreadMasks[0]);  // as spread_bits
    x = spread<16>(x, kSpreadMasks[1]);
    x = spread<8>(x, kSpreadMasks[2]);
    x = spread<4>(x, kSpreadMasks[3]);
    x = spread<2>(x, kSpreadMasks[4]);
    x = hn::Shl(x, places_);
    const hn::FixedTag<std::uint64_t, 2> half;
    const auto both = hn::Or(hn::LowerHalf(half, x), hn::UpperHalf(half, x));
    return hn::GetLane(both) | hn::ExtractLane(both, 1);
  }

 private:
  using Doubles = hn::FixedTag<double, 4>;
  using Words = hn::FixedTag<std::uint64_t, 4>;
  template <int kBits>
  static HWY_INLINE hn::Vec<Words> spread(hn::Vec<Words> x, std::uint64_t mask) {
    return hn::And(hn::Or(x, hn::ShiftLeft<kBits>(x)), hn::Set(Words(), mask));
  }
  hn::Vec<Doubles> lower_, scale_, last_cell_;
  hn::Vec<Words> places_;
};

#else

class Coder {
 public:
  explicit Coder(const MortonGrid& grid) : grid_(grid) {}
  std::uint64_t code(const Reference& reference) const { return grid_.code(reference.centroid2()); }

 private:
  MortonGrid grid_;
};

#endif

void morton_codes(const MortonGrid& grid, const Reference* references, std::size_t begin, std::size_t end,
                  KeyedIndex* codes) {
  const Coder coder(grid);
  for (std::size_t r = begin; r < end; ++r)
    codes[r - begin] = {coder.code(references[r]), static_cast<std::uint32_t>(r), 0};
}

ReferenceKernels kernels() {
  return {hwy::TargetName(HWY_TARGET), bin, best_split, part, morton_codes};
}

}  // namespace boxwood::builders::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/simd_dispatch.h"

namespace boxwood::builders {

HWY_EXPORT(kernels);

std::vector<ReferenceKernels> all_reference_kernels() {
  std::vector<ReferenceKernels> all;
  // The better a target, the lower its bit; the baseline runs everywhere.
  for (std::int64_t targets = (hwy::SupportedTargets() & HWY_TARGETS) | HWY_STATIC_TARGET; targets != 0;
       targets &= targets - 1)
    all.push_back(HWY_DISPATCH_TABLE(kernels)[dispatch_index(targets & -targets)]());
  return all;
}

const ReferenceKernels& reference_kernels() {
  static const ReferenceKernels best = all_reference_kernels().front();
  return best;
}

}  // namespace boxwood::builders
#endif
