// The quality levels, and the one function that turns names into what runs.
#include <algorithm>

#include "boxwood/accel.h"

namespace boxwood {
namespace {

using Setting = std::pair<const char*, const char*>;

/// A wide layout tests four triangles at once, so a subtree of a few is hardly ever worth its nodes: with these prices
/// the builder stops there, where the collapse would make a leaf anyway, and pairs need not be told apart before
/// (docs/best-tree.md).
constexpr Setting kFastSettings[] = {{"cost.intersection", "0.15"},
                                     {"merge.most", "2"},
                                     {"merge.growth", "1"},
                                     {"merge.least", "0.4"},
                                     {"treelet.bits", "10"}};
constexpr Setting kBalancedSettings[] = {{"cost.intersection", "0.4"}, {"merge.most", "2"}, {"merge.growth", "1"}};

/// Planes where the sides overlap by less than a thousandth of the root's area cost the builder two fifths of its time
/// for 0.6 % fewer nodes and triangles per ray (docs/best-tree.md).
constexpr Setting kBestSettings[] = {{"alpha", "0.001"}};

constexpr QualityLevel kLevels[] = {
    {.id = "fast",
     .summary = "for trees that are rebuilt often",
     .presplit = "none",
     .builder = "hlbvh",
     .settings = kFastSettings,
     .optimizer = "none",
     .second_builder = nullptr,
     .build_cost = "0.38 on one thread, 0.46 on two",
     .memory = "about that of balanced"},
    {.id = "balanced",
     .summary = "the default: quick to build, good to trace",
     .presplit = "none",
     .builder = "binned-sah",
     .settings = kBalancedSettings,
     .optimizer = "none",
     .second_builder = nullptr,
     .build_cost = "1",
     .memory = "43 to 56 bytes per triangle"},
    {.id = "best",
     .summary = "for trees that are traced for long",
     .presplit = "none",
     .builder = "sbvh",
     .settings = kBestSettings,
     .optimizer = "reinsertion",
     .second_builder = "sweep-sah",
     .build_cost = "7 to 26",
     .memory = "1.03 to 1.15 times balanced"},
};

std::string known_levels() {
  std::string list;
  for (const QualityLevel& level : kLevels) list += std::string(list.empty() ? "" : ", ") + level.id;
  return list;
}

/// The second builder with those of the settings asked for that it has.
builders::BuildOptions second_build(const QualityLevel& level, const builders::BuildOptions& asked) {
  builders::BuildOptions build{.builder = {}, .settings = {}};
  if (!level.second_builder) return build;
  build.builder = level.second_builder;
  const auto& known = builders::find(build.builder)->options;
  for (const auto& [key, value] : asked.settings)
    if (std::any_of(known.begin(), known.end(), [&key = key](const auto& option) { return key == option.key; }))
      build.settings.emplace(key, value);
  return build;
}

}  // namespace

std::span<const QualityLevel> quality_levels() {
  return kLevels;
}

const QualityLevel* find_quality_level(std::string_view id) {
  const auto* const level =
      std::find_if(std::begin(kLevels), std::end(kLevels), [&](const auto& l) { return id == l.id; });
  return level == std::end(kLevels) ? nullptr : level;
}

Result<TreePlan> plan_tree(const builders::BuildOptions& build, std::string_view presplit, std::string_view optimizer) {
  try {
    TreePlan plan;
    plan.build = build;
    plan.level = find_quality_level(build.builder);
    if (plan.level) {
      plan.build.builder = plan.level->builder;
      for (const auto& [key, value] : plan.level->settings) plan.build.settings.emplace(key, value);
      if (presplit.empty()) presplit = plan.level->presplit;
      if (optimizer.empty()) optimizer = plan.level->optimizer;
      plan.second = second_build(*plan.level, build);
    } else if (!builders::find(build.builder)) {
      const auto unknown = builders::resolve_options(build.builder, build.settings);
      return {ErrorCode::unknown_name, unknown.error().message + "; quality levels are: " + known_levels()};
    }
    if (auto resolved = builders::resolve_options(plan.build.builder, plan.build.settings); !resolved)
      return resolved.error();
    plan.cost = builders::resolve_options(plan.build.builder, build.settings)->cost();
    auto parsed_presplit = refs::parse_presplit(presplit.empty() ? "none" : presplit);
    if (!parsed_presplit) return parsed_presplit.error();
    plan.presplit = std::move(*parsed_presplit);
    auto parsed_optimizer = optimizers::parse_optimizer(optimizer.empty() ? "none" : optimizer);
    if (!parsed_optimizer) return parsed_optimizer.error();
    plan.optimizer = std::move(*parsed_optimizer);
    return plan;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "out of memory while reading the options of a build"};
  }
}

std::vector<std::pair<std::string, std::string>> TreePlan::echo() const {
  std::vector<std::pair<std::string, std::string>> echo;
  if (level) echo.emplace_back("level", level->id);
  echo.emplace_back("builder", build.builder);
  echo.emplace_back("presplit", presplit.text());
  echo.emplace_back("optimizer", optimizer.text());
  if (!second.builder.empty()) echo.emplace_back("second_builder", second.builder);
  if (const auto resolved = builders::resolve_options(build.builder, build.settings))
    for (auto& entry : resolved->echo()) echo.push_back(std::move(entry));
  return echo;
}

}  // namespace boxwood
