#include "duel/ablation.h"

#include <sys/prctl.h>

#include <functional>

#include "duel/tracing.h"
#include "progress.h"

namespace boxwood::program::duel {
namespace {

/// A thing to leave out. `leave_out` gives false where `options` do without it anyway.
struct Technique {
  const char* name;
  std::function<bool(AccelOptions& options)> leave_out;
  bool huge_pages = true;
  queries::Mode mode = queries::Mode::fast;
  Way way = Way::single;
};

bool differs(std::string& value, const char* without) {
  if (value == without) return false;
  value = without;
  return true;
}

bool leave_out_presplit(AccelOptions& options) {
  const auto plan = plan_tree(options.build, options.presplit, options.optimizer);
  return plan && !plan->presplit.is_none() && differs(options.presplit, "none");
}

bool leave_out_optimizer(AccelOptions& options) {
  const auto plan = plan_tree(options.build, options.presplit, options.optimizer);
  return plan && plan->optimizer.text() != "none" && differs(options.optimizer, "none");
}

/// Overlaps never exceed the root's area, so with alpha = 1 no plane is tried.
bool leave_out_spatial_splits(AccelOptions& options) {
  const auto plan = plan_tree(options.build, options.presplit, options.optimizer);
  return plan && plan->build.builder == "sbvh" && differs(options.build.settings["alpha"], "1");
}

/// What the level stands for but for its second tree.
bool leave_out_second_tree(AccelOptions& options) {
  const auto plan = plan_tree(options.build, options.presplit, options.optimizer);
  if (!plan || plan->second.builder.empty()) return false;
  options.build = plan->build;
  options.presplit = plan->presplit.text();
  options.optimizer = plan->optimizer.text();
  return true;
}

/// One price for all layouts instead of each its own.
bool leave_out_node_price(AccelOptions& options) {
  constexpr float kForAll = 2;
  const auto id = layouts::find(options.layout);
  if (!id || *id == layouts::LayoutId::linear || layouts::node_cost(*id) == kForAll) return false;
  options.node_cost = kForAll;
  return true;
}

const std::vector<Technique>& techniques() {
  const auto nothing = [](AccelOptions&) { return true; };
  static const std::vector<Technique> list{
      {"pre-split", leave_out_presplit},
      {"spatial splits", leave_out_spatial_splits},
      {"reinsertion", leave_out_optimizer},
      {"a second tree of whole triangles", leave_out_second_tree},
      {"sixteen children a node", [](AccelOptions& o) { return o.layout == "wide16" && differs(o.layout, "wide8"); }},
      {"eight children a node", [](AccelOptions& o) { return o.layout == "wide8" && differs(o.layout, "wide4"); }},
      {"quads",
       [](AccelOptions& o) {
         return o.layout.ends_with("-quads") && differs(o.layout, o.layout.substr(0, o.layout.size() - 6).c_str());
       }},
      {"the layout's node price (2 blocks instead)", leave_out_node_price},
      {"wide nodes and blocks", [](AccelOptions& o) { return differs(o.layout, "linear"); }},
      {"huge pages", nothing, false},
      {"fast mode (robust instead)", nothing, true, queries::Mode::robust},
  };
  return list;
}

/// One of those that run in turns; the first is the whole.
struct Variant {
  const Technique* technique = nullptr;
  Own own;
  double build_seconds = 0;
};

/// Memory that is first touched meanwhile lies in small pages.
class HugePages {
 public:
  explicit HugePages(bool on) : changed_(!on) {
    if (changed_) prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
  }
  ~HugePages() {
    if (changed_) prctl(PR_SET_THP_DISABLE, 0, 0, 0, 0);
  }
  HugePages(const HugePages&) = delete;
  HugePages& operator=(const HugePages&) = delete;

 private:
  bool changed_;
};

double percent(double part, double whole) {
  return whole > 0 ? 100 * (part / whole - 1) : 0;
}

Status build_all(std::vector<Variant>& variants, const Input& input, const std::shared_ptr<Executor>& executor) {
  // The first build of a process pays for what the others find done.
  if (const auto warm_up = build(variants[0].own, input, executor); !warm_up) return warm_up.error();
  for (Variant& variant : variants) {
    const HugePages pages(!variant.technique || variant.technique->huge_pages);
    const auto seconds = build(variant.own, input, executor);
    if (!seconds) return Error{seconds.error().code, variant.own.name + ": " + seconds.error().message};
    variant.build_seconds = *seconds;
  }
  return {};
}

/// All variants and the whole's batch in turns; rows in the order of the variants, then the batch.
Status trace_set(const Set& set, const std::vector<Variant>& variants, const Plan& plan, Executor& executor,
                 AblationResult& result) {
  std::vector<Tracer> tracers;
  for (const Variant& v : variants)
    tracers.push_back({&v.own, nullptr, v.technique ? v.technique->way : Way::single,
                       v.technique ? v.technique->mode : queries::Mode::fast});
  tracers.push_back({&variants[0].own, nullptr, Way::batch});
  std::vector<Tracer*> pointers;
  for (Tracer& tracer : tracers) pointers.push_back(&tracer);
  if (Status status = measure(set, pointers, plan.repeat, executor); !status) return status;
  const auto cost = [](const std::vector<double>& without, const std::vector<double>& with) {
    std::vector<double> costs;
    for (const double ratio : ratios(without, with)) costs.push_back(percent(ratio, 1));
    return spread_of(costs);
  };
  for (std::size_t i = 1; i < variants.size(); ++i)
    result.rows[i - 1].rays.push_back({set.name, cost(tracers[i].seconds, tracers[0].seconds)});
  result.rows.back().rays.push_back({set.name, cost(tracers[0].seconds, tracers.back().seconds)});
  return {};
}

}  // namespace

Result<AblationResult> ablate(const Plan& plan, const AccelOptions& whole, const Input& input, const Session& session) {
  AblationResult result{input.mesh.name, input.mesh.triangles.size(), {}, {}};
  std::vector<Variant> variants{{nullptr, {"whole", whole, nullptr}, 0}};
  for (const Technique& technique : techniques()) {
    AccelOptions options = whole;
    if (technique.leave_out(options))
      variants.push_back({&technique, {technique.name, options, nullptr}, 0});
    else
      result.left_out.push_back(fmt::format("{}: {} does without", technique.name, whole.build.builder));
  }
  Progress progress(input.mesh.name + ": ablation", session.shows_progress());
  const auto one = session.make_executor(1);
  const auto executor = std::make_shared<SwitchedExecutor>(session.executor());
  if (Status status = build_all(variants, input, executor); !status) return status.error();
  for (std::size_t i = 1; i < variants.size(); ++i)
    result.rows.push_back({variants[i].own.name,
                           percent(variants[i].build_seconds, variants[0].build_seconds),
                           percent(static_cast<double>(variants[i].own.accel->bytes()),
                                   static_cast<double>(variants[0].own.accel->bytes())),
                           {}});
  result.rows.push_back({"batches (single calls instead)", 0, 0, {}});
  auto sets = make_sets(plan, input, *variants[0].own.accel, session);
  if (!sets) return sets.error();
  executor->set(one);
  for (const Set* set : {&sets->primary, &sets->random, &sets->diffuse, &sets->occlusion}) {
    if (set->rays.empty()) continue;
    progress.label(fmt::format("{}: {} rays", input.mesh.name, set->name));
    if (Status status = trace_set(*set, variants, plan, *one, result); !status) return status.error();
  }
  return result;
}

}  // namespace boxwood::program::duel
