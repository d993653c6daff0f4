// Names of test cases that run over all builders.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "boxwood/builders.h"

namespace boxwood::test {

/// The id of the registry's row that is the parameter, as GoogleTest wants names: "sweep_sah".
inline std::string builder_name(const ::testing::TestParamInfo<std::size_t>& param) {
  std::string name = builders::registry()[param.param].id;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
}

}  // namespace boxwood::test
