// All of the core library. boxwood/io.h and boxwood/render.h belong to targets of their own.
#pragma once

#include "boxwood/accel.h"
#include "boxwood/base.h"
#include "boxwood/builders.h"
#include "boxwood/layouts.h"
#include "boxwood/math.h"
#include "boxwood/mesh.h"
#include "boxwood/metrics.h"
#include "boxwood/optimizers.h"
#include "boxwood/parallel.h"
#include "boxwood/queries.h"
#include "boxwood/refs.h"
#include "boxwood/tree.h"
