// The builders: a registry of all of them and one function that runs any.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/parallel.h"
#include "boxwood/refs.h"
#include "boxwood/tree.h"

namespace boxwood::builders {

/// One option of a builder: what help, documentation, checks and the echo in reports come from.
/// Numbers: `choices` empty, valid from `lowest` to `highest`. Choices: a list of words; the default is `choices[0]`.
struct OptionSpec {
  const char* key;          ///< "bins", "cost.traversal"
  const char* description;  ///< one line with the paper where it has one
  double default_value = 0;
  double lowest = 0, highest = 0;
  bool integer = false;
  std::span<const char* const> choices = {};
};

/// The resolved options of one build: every option of the builder has a value. Made by resolve_options.
class OptionValues {
 public:
  double number(std::string_view key) const;          ///< of a number; the key must exist
  std::uint32_t integer(std::string_view key) const;  ///< of an integer option
  std::size_t choice(std::string_view key) const;     ///< index into the option's choices
  tree::CostModel cost() const;                       ///< cost.traversal and cost.intersection
  bool has(std::string_view key) const;               ///< does the builder have this option?
  void set(std::string_view key, double value);       ///< of a number; the key must exist, the range is not checked
  /// Key and value as text, in the registry's order: what reports echo.
  std::vector<std::pair<std::string, std::string>> echo() const;

 private:
  friend Result<OptionValues> resolve_options(std::string_view, const std::map<std::string, std::string>&);
  struct Entry {
    const OptionSpec* spec;
    double value;
  };
  const Entry& entry(std::string_view key) const;
  std::vector<Entry> entries_;
};

/// What runs beside a build: threads, progress, cancellation.
struct BuildContext {
  Executor& executor;
  /// Called now and then, from any thread but never two at a time, with the share done, 0 to 1. May be empty.
  std::function<void(double)> progress = {};
  /// Set it from another thread to end the build early; it then returns an error.
  const std::atomic<bool>* cancel = nullptr;
};

/// One row of the registry.
struct BuilderInfo {
  const char* id;                       ///< "sweep-sah"
  const char* name;                     ///< "Full-sweep SAH"
  const char* summary;                  ///< one line that ends with what it is best for
  const char* paper;                    ///< bib key(s) in docs/references.bib
  const char* cost_class;               ///< "O(n log n)"
  bool splits_references;               ///< may reference a primitive more than once
  std::uint64_t largest_sensible;       ///< references above which it is refused
  std::span<const OptionSpec> options;  ///< its own; every builder also has the common ones (common_options)
  /// Builds over a non-empty set, which it may reorder. Options are resolved and checked.
  Result<tree::BinaryTree> (*build)(refs::ReferenceSet&& references, const OptionValues& options,
                                    const BuildContext& context);
};

/// All builders, in the order they are listed to people.
std::span<const BuilderInfo> registry();
/// The row of an id, or null.
const BuilderInfo* find(std::string_view id);
/// Options that every builder has: cost.traversal, cost.intersection.
std::span<const OptionSpec> common_options();

/// Checks `settings` (option key to value text) against the builder's options and fills in defaults. Errors: unknown
/// builder (lists what there is), unknown key (lists the builder's keys), value not a number, out of range, or no such
/// choice.
Result<OptionValues> resolve_options(std::string_view builder, const std::map<std::string, std::string>& settings);

/// How to build. `settings` by key, as on the command line: {{"bins", "32"}, {"cost.traversal", "2"}}.
struct BuildOptions {
  std::string builder = "binned-sah";
  std::map<std::string, std::string> settings = {};
};

/// Builds a tree over references. An empty set gives an empty tree. The same references and options give the same bits
/// for every executor. Errors: those of resolve_options, more references than the builder's limit, a reference with an
/// unknown primitive or a box that is empty, not finite or beyond kLargestCoordinate, cancelled, out of memory. Thread
/// safe.
Result<tree::BinaryTree> build(refs::ReferenceSet&& references, const BuildOptions& options,
                               const BuildContext& context);

/// Stands for "no cluster" in what edge_clusters returns.
inline constexpr std::uint32_t kNoCluster = 0xffffffffu;

/// The cluster of each primitive after so many rounds of merging over shared edges, as in EBBVH's figures 1 to 4
/// (Houghton and Spoerer): numbered from 0 in the order of their first references; kNoCluster for primitives
/// without a reference. No rounds: each reference is its own. Errors: a reference to an unknown primitive, cancelled,
/// out of memory.
Result<std::vector<std::uint32_t>> edge_clusters(const refs::ReferenceSet& references, std::uint32_t rounds,
                                                 mesh::Weld weld, const BuildContext& context);

}  // namespace boxwood::builders
