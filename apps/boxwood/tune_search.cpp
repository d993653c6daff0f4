#include "tune_search.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "progress.h"
#include "text.h"

namespace boxwood::program {
namespace {

/// What is tried first, as far as the library has it: quick ones that show what there is to win, then slower ones.
constexpr const char* kBuilders[] = {"sbvh", "hlbvh", "sweep-sah", "ebbvh-gated", "ploc", "lbvh", "aac"};
constexpr const char* kPresplits[] = {"evh:auto", "evh:clip"};

/// Traces of one candidate in turns with the reference: at least this many, and until so much time has gone.
constexpr int kFewestTurns = 3;
constexpr double kTurnSeconds = 0.25;
constexpr int kMostTurns = 15;

struct Built {
  Accel accel;
  double seconds;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TuneChoice choice_of(const char* builder) {
  TuneChoice choice;
  choice.build.builder = builder;
  return choice;
}

class Search {
 public:
  Search(const Input& input, const TuneRaySets& rays, const TuneLimits& limits, const Session& session)
      : input_(input),
        rays_(rays),
        mode_(limits.mode),
        session_(session),
        end_(now() + limits.seconds),
        progress_("tuning", session.shows_progress()),
        start_(now()) {
    hits_.resize(std::max(rays.tested.closest.size(), rays.tested.any.size()));
    occluded_.resize(hits_.size());
  }

  Result<std::vector<TuneResult>> run() {
    // The default, which everything is measured against, has no time limit.
    const double end = std::exchange(end_, kInfinity);
    if (Status status = attempt({}); !status) return status.error();
    end_ = end;
    if (Status status = try_all(); !status) return status.error();
    mark_front();
    return std::move(results_);
  }

 private:
  bool has_time() const { return now() < end_; }

  Status try_all() {
    const auto levels = quality_levels();
    for (std::size_t i = levels.size(); i-- > 0;)
      if (Status status = attempt(choice_of(levels[i].id)); !status) return status;
    for (const char* id : kBuilders)
      if (const auto* builder = builders::find(id);
          builder && input_.mesh.triangles.size() <= builder->largest_sensible)
        if (Status status = attempt(choice_of(id)); !status) return status;
    if (Status status = vary_fastest(&Search::with_optimizing); !status) return status;
    for (const auto vary :
         {&Search::with_layouts, &Search::with_optimizers, &Search::with_presplits, &Search::with_settings})
      if (Status status = vary_fastest(vary); !status) return status;
    // The fastest so far may be another one by now.
    return vary_fastest(&Search::with_optimizing);
  }

  /// Tries variations of the fastest that is not optimized, and optimizes what turns out to be the fastest then.
  Status vary_fastest(std::vector<TuneChoice> (Search::*vary)(const TuneChoice&) const) {
    const TuneResult* best = nullptr;
    for (const TuneResult& r : results_)
      if (!r.choice.optimized && (!best || r.ratio > best->ratio)) best = &r;
    for (const TuneChoice& choice : (this->*vary)(TuneChoice(best->choice)))
      if (Status status = attempt(choice); !status) return status;
    return {};
  }

  std::vector<TuneChoice> with_optimizing(const TuneChoice& base) const {
    TuneChoice best = base, first = results_.front().choice;
    best.optimized = first.optimized = true;
    return {best, first};
  }
  std::vector<TuneChoice> with_layouts(const TuneChoice& base) const {
    std::vector<TuneChoice> choices;
    for (const auto& layout : layouts::registry())
      if (layout.id != layouts::LayoutId::linear) choices.push_back(base), choices.back().layout = layout.name;
    return choices;
  }
  std::vector<TuneChoice> with_presplits(const TuneChoice& base) const {
    std::vector<TuneChoice> choices;
    for (const char* presplit : kPresplits)
      if (const auto parsed = refs::parse_presplit(presplit))
        choices.push_back(base), choices.back().presplit = parsed->text();
    return choices;
  }
  std::vector<TuneChoice> with_optimizers(const TuneChoice& base) const {
    std::vector<TuneChoice> choices;
    for (const auto& row : optimizers::optimizer_registry())
      if (const auto plan = plan_tree(base.build, base.presplit, base.optimizer); plan && plan->optimizer.info != &row)
        choices.push_back(base), choices.back().optimizer = row.id;
    return choices;
  }
  /// Each number of the builder halved and doubled, each of its other choices.
  std::vector<TuneChoice> with_settings(const TuneChoice& base) const {
    std::vector<TuneChoice> choices;
    const auto plan = plan_tree(base.build, base.presplit, base.optimizer);
    const auto* builder = plan ? builders::find(plan->build.builder) : nullptr;
    if (!builder) return choices;
    const auto add = [&](const builders::OptionSpec& spec, const std::string& value) {
      choices.push_back(base);
      choices.back().build.settings[spec.key] = value;
      if (!plan_tree(choices.back().build)) choices.pop_back();
    };
    for (const auto& spec : builder->options) {
      for (std::size_t i = 1; i < spec.choices.size(); ++i) add(spec, spec.choices[i]);
      if (!spec.choices.empty() || spec.default_value == 0) continue;
      for (const double factor : {0.5, 2.0}) {
        const double value = factor * spec.default_value;
        add(spec, spec.integer ? fmt::format("{}", std::llround(value)) : fmt::format("{:g}", value));
      }
    }
    return choices;
  }

  bool was_tried(const TuneChoice& choice) const {
    return std::any_of(tried_.begin(), tried_.end(), [&](const std::string& t) { return t == choice.text(); });
  }

  /// Builds and measures when there is time and it was not tried before. What does not end in time is left out.
  Status attempt(const TuneChoice& choice) {
    if (!has_time() || was_tried(choice)) return {};
    tried_.push_back(choice.text());
    progress_.label("tuning: " + choice.text());
    progress_.update(std::isfinite(end_) ? std::min(1.0, (now() - start_) / (end_ - start_)) : -1);
    auto built = build(choice);
    if (!built) return built.error().code == ErrorCode::cancelled ? Status{} : Status(built.error());
    TuneResult result{choice, built->seconds, 0, 1, built->accel.bytes(), false};
    if (!reference_) reference_.emplace(std::move(built->accel));
    measure(results_.empty() ? *reference_ : built->accel, result);
    results_.push_back(std::move(result));
    return {};
  }

  Result<Built> build(const TuneChoice& choice) {
    Executor& executor = *session_.executor();
    const double start = now();
    std::atomic<bool> cancel{false};
    const auto watch = [&](double) { cancel = !has_time(); };
    const auto plan = plan_tree(choice.build, choice.presplit, choice.optimizer);
    if (!plan) return plan.error();
    const auto tree = boxwood::build_tree(input_.mesh, *plan, {executor, watch, &cancel});
    if (!tree) return tree.error();
    AccelOptions options;
    options.layout = choice.layout;
    options.executor = session_.executor();
    auto accel = Accel::from_tree(input_.mesh, *tree, options);
    if (!accel) return accel.error();
    if (choice.optimized) {
      auto optimized = accel->optimize({rays_.trained.closest, rays_.trained.any});
      if (!optimized) return optimized.error();
      accel = std::move(optimized->accel);
    }
    return Built{std::move(*accel), now() - start};
  }

  double trace(const Accel& accel) {
    const double start = now();
    const auto& [closest, any] = rays_.tested;
    // Both can fail only for spans of unequal length or without memory for a stack.
    (void)accel.closest_hits(closest, std::span(hits_).first(closest.size()), {}, mode_);
    (void)accel.any_hits(any, std::span(occluded_).first(any.size()), mode_);
    return std::max(now() - start, 1e-9);
  }

  void measure(const Accel& accel, TuneResult& result) {
    std::vector<double> seconds, ratios;
    const double start = now();
    trace(accel);  // once for the caches
    double before = trace(*reference_);
    for (int turn = 0; turn < kMostTurns && (turn < kFewestTurns || now() - start < kTurnSeconds); ++turn) {
      seconds.push_back(trace(accel));
      const double after = trace(*reference_);
      // Between two runs of the reference, of which the quicker was disturbed less.
      ratios.push_back(std::min(before, after) / seconds.back());
      before = after;
    }
    result.mrays = 1e-6 * double(rays_.tested.size()) / median(seconds);
    result.ratio = results_.empty() ? 1 : median(ratios);
  }

  void mark_front() {
    for (TuneResult& r : results_)
      r.is_on_front = std::none_of(results_.begin(), results_.end(), [&](const TuneResult& o) {
        const bool no_worse = o.build_seconds <= r.build_seconds && o.ratio >= r.ratio && o.bytes <= r.bytes;
        const bool better = o.build_seconds < r.build_seconds || o.ratio > r.ratio || o.bytes < r.bytes;
        return no_worse && better;
      });
  }

  const Input& input_;
  const TuneRaySets& rays_;
  queries::Mode mode_;
  const Session& session_;
  double end_;
  Progress progress_;
  double start_;
  std::vector<TuneResult> results_;
  std::vector<std::string> tried_;
  std::optional<Accel> reference_;
  std::vector<Hit> hits_;
  std::vector<std::uint8_t> occluded_;
};

}  // namespace

std::string TuneChoice::text() const {
  std::string text = build.builder;
  for (const auto& [key, value] : build.settings) text += fmt::format(" {}={}", key, value);
  if (!presplit.empty()) text += ", " + presplit;
  if (!optimizer.empty()) text += fmt::format(", {}", optimizer == "none" ? "no optimizer" : optimizer);
  return text + ", " + layout + (optimized ? ", optimized" : "");
}

std::string TuneChoice::command_line() const {
  std::string text = "--builder " + build.builder;
  for (const auto& [key, value] : build.settings) text += fmt::format(" --set {}={}", key, value);
  if (!presplit.empty()) text += " --presplit " + presplit;
  if (!optimizer.empty()) text += " --optimizer " + optimizer;
  return text + " --layout " + layout;
}

std::string TuneChoice::code() const {
  std::string settings;
  for (const auto& [key, value] : build.settings)
    settings += fmt::format("{}{{\"{}\", \"{}\"}}", settings.empty() ? "" : ", ", key, value);
  std::string text = fmt::format("auto accel = boxwood::Accel::build(mesh, {{.build = {{.builder = \"{}\"{}}}, ",
                                 build.builder, settings.empty() ? "" : ", .settings = {" + settings + "}");
  if (!presplit.empty()) text += fmt::format(".presplit = \"{}\", ", presplit);
  if (!optimizer.empty()) text += fmt::format(".optimizer = \"{}\", ", optimizer);
  text += fmt::format(".layout = \"{}\"}});", layout);
  if (optimized) text += " auto optimized = accel->optimize({.closest_hit = rays, .any_hit = shadow_rays});";
  return text;
}

Result<std::vector<TuneResult>> search(const Input& input, const TuneRaySets& rays, const TuneLimits& limits,
                                       const Session& session) {
  return Search(input, rays, limits, session).run();
}

std::size_t recommended(const std::vector<TuneResult>& results) {
  double fastest = 0;
  for (const TuneResult& r : results) fastest = std::max(fastest, r.ratio);
  std::size_t best = results.size();
  for (std::size_t i = 0; i < results.size(); ++i)
    if (results[i].ratio >= 0.95 * fastest &&
        (best == results.size() || results[i].build_seconds < results[best].build_seconds))
      best = i;
  return best;
}

}  // namespace boxwood::program
