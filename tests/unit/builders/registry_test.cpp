#include <gtest/gtest.h>

#include <set>

#include "boxwood/builders.h"

namespace boxwood {
namespace {

TEST(Registry, RowsAreCompleteAndUnique) {
  std::set<std::string> ids;
  for (const builders::BuilderInfo& info : builders::registry()) {
    EXPECT_TRUE(ids.insert(info.id).second) << info.id;
    EXPECT_EQ(builders::find(info.id), &info);
    EXPECT_NE(std::string(info.name), "");
    EXPECT_NE(std::string(info.summary).find("best for"), std::string::npos) << info.id;
    EXPECT_NE(std::string(info.paper), "");
    EXPECT_GT(info.largest_sensible, 10'000'000u);
    EXPECT_NE(info.build, nullptr);
  }
  for (const char* id : {"middle", "equal-counts", "binned-sah", "sweep-sah", "lbvh", "hlbvh"})
    EXPECT_TRUE(ids.contains(id)) << id;
}

TEST(Registry, OptionsAreWellFormedAndDoNotCollide) {
  for (const builders::BuilderInfo& info : builders::registry()) {
    std::set<std::string> keys;
    for (const auto& specs : {builders::common_options(), info.options}) {
      for (const builders::OptionSpec& spec : specs) {
        SCOPED_TRACE(std::string(info.id) + " " + spec.key);
        EXPECT_TRUE(keys.insert(spec.key).second);
        EXPECT_NE(std::string(spec.description), "");
        if (!spec.choices.empty()) continue;
        EXPECT_LT(spec.lowest, spec.highest);
        EXPECT_GE(spec.default_value, spec.lowest);
        EXPECT_LE(spec.default_value, spec.highest);
      }
    }
  }
}

TEST(Registry, UnknownIdIsNotFound) {
  EXPECT_EQ(builders::find("no-such-builder"), nullptr);
  EXPECT_EQ(builders::find(""), nullptr);
}

}  // namespace
}  // namespace boxwood
