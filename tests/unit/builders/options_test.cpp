#include <gtest/gtest.h>

#include "boxwood/builders.h"

namespace boxwood {
namespace {

using builders::resolve_options;

void expect_error(const std::map<std::string, std::string>& settings, ErrorCode code, const std::string& part,
                  const char* builder = "binned-sah") {
  const auto values = resolve_options(builder, settings);
  ASSERT_FALSE(values) << part;
  EXPECT_EQ(values.error().code, code) << values.error().message;
  EXPECT_NE(values.error().message.find(part), std::string::npos) << values.error().message;
}

TEST(Options, DefaultsAreFilledIn) {
  const auto values = resolve_options("binned-sah", {});
  ASSERT_TRUE(values);
  EXPECT_EQ(values->integer("bins"), 16u);
  EXPECT_EQ(values->choice("axes"), 0u);
  EXPECT_EQ(values->cost().traversal, 1.0f);
  EXPECT_EQ(values->cost().intersection, 1.5f);
}

TEST(Options, SettingsReplaceDefaults) {
  const auto values = resolve_options(
      "binned-sah", {{"bins", "8"}, {"axes", "longest"}, {"cost.traversal", "2.5"}, {"cost.intersection", "3e0"}});
  ASSERT_TRUE(values);
  EXPECT_EQ(values->integer("bins"), 8u);
  EXPECT_EQ(values->choice("axes"), 1u);
  EXPECT_EQ(values->number("cost.traversal"), 2.5);
  EXPECT_EQ(values->cost().intersection, 3.0f);
}

TEST(Options, EchoListsAllInRegistryOrder) {
  const auto values = resolve_options("binned-sah", {{"axes", "longest"}, {"cost.intersection", "0.25"}});
  ASSERT_TRUE(values);
  const std::vector<std::pair<std::string, std::string>> expected{
      {"cost.traversal", "1"}, {"cost.intersection", "0.25"}, {"bins", "16"},          {"axes", "longest"},
      {"leaf.max", "16"},      {"merge.most", "1"},           {"merge.growth", "0.8"}, {"merge.least", "0"}};
  EXPECT_EQ(values->echo(), expected);
}

TEST(Options, EchoCanBeReadBack) {
  const auto values = resolve_options("binned-sah", {{"cost.traversal", "0.1"}, {"bins", "7"}});
  ASSERT_TRUE(values);
  std::map<std::string, std::string> settings;
  for (const auto& [key, text] : values->echo()) settings[key] = text;
  const auto again = resolve_options("binned-sah", settings);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->number("cost.traversal"), values->number("cost.traversal"));
  EXPECT_EQ(again->echo(), values->echo());
}

TEST(Options, UnknownNamesListWhatThereIs) {
  expect_error({}, ErrorCode::unknown_name, "sweep-sah", "nonsense");
  expect_error({}, ErrorCode::unknown_name, "'nonsense'", "nonsense");
  expect_error({{"bin", "8"}}, ErrorCode::unknown_name, "'bin'");
  expect_error({{"bin", "8"}}, ErrorCode::unknown_name, "cost.traversal, cost.intersection, bins, axes, leaf.max");
  expect_error({{"bins", "8"}}, ErrorCode::unknown_name, "'bins'", "middle");
  expect_error({{"axes", "widest"}}, ErrorCode::unknown_name, "all, longest");
}

TEST(Options, MalformedNumbersAreRefused) {
  for (const char* text : {"", " 8", "8 ", "eight", "8x", "0x8", "1e", "--8", "8,0"})
    expect_error({{"bins", text}}, ErrorCode::invalid_argument, "'bins' of builder 'binned-sah' must be a number");
}

TEST(Options, NumbersOutOfRangeAreRefused) {
  for (const char* text : {"1", "257", "-8", "8.5", "nan", "inf", "1e999", "1e-999"})
    expect_error({{"bins", text}}, ErrorCode::out_of_range, "from 2 to 256, not '" + std::string(text) + "'");
  for (const char* text : {"-1", "1000001", "nan"})
    expect_error({{"cost.traversal", text}}, ErrorCode::out_of_range, "");
  for (const char* text : {"0", "-1", "1000001"})
    expect_error({{"cost.intersection", text}}, ErrorCode::out_of_range, "");
}

}  // namespace
}  // namespace boxwood
