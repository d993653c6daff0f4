// The top-down driver: takes ranges of references apart with a split finder until only leaves are left.
//
// A split finder is a class with
//   Split find(const BuildRange&, Executor&)       the split to make; Split::is_leaf() says to make none
//   Split median(const BuildRange&)                a split into two halves, which always works
//   void apply(const Split&, const BuildRange&, Executor&, BuildRange& left, BuildRange& right)
//                                                  sorts the references and fills in all of both ranges but slot, depth
//   void write_leaf(const BuildRange&, std::uint32_t* ids)
// It is called for disjoint ranges from several threads at once. A finder that makes small subtrees by itself has, in
// place of the last,
//   bool finishes(const BuildRange&)               does it make the subtree over the range?
//   void finish(const BuildRange&, SubtreeCursor&) does so, in canonical order, its root in the range's slot; without
//                                                  `finishes` said, it makes a leaf
//
// Ranges worth a task are split in rounds, breadth first: few large ones one after the other, each by a parallel find
// and apply, all others side by side; then each small range is finished by one thread. This goes depth first, left
// before right, and takes places for nodes and references one after the other in a piece of its own: so the piece is in
// canonical order, and tree::join_pieces copies it as it is. Nothing recurses, and neither counters nor places depend
// on the order of threads. Past kDepthLimit ranges are halved, which bounds the depth of the tree by kDepthLimit +
// log2(n).
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "builders/parts/build_monitor.h"
#include "builders/parts/build_range.h"
#include "tree/join_pieces.h"

namespace boxwood::builders {

/// Deep enough for any input that a heuristic splits with sense, far below what a traversal has to fear.
inline constexpr std::uint32_t kDepthLimit = 96;

/// Where the nodes and references of a piece go, in canonical order.
struct SubtreeCursor {
  tree::Node* nodes;   ///< of the piece, whose root is number 0
  std::uint32_t* ids;  ///< of all pieces
  std::uint32_t next_node, next_id;

  /// The place of two children.
  std::uint32_t take_pair() {
    next_node += 2;
    return next_node - 2;
  }
};

/// A tree in pieces, as the driver leaves it.
struct TreePieces {
  LargeVector<tree::TopNode> top;
  AlignedBuffer<tree::Node> nodes;
  AlignedBuffer<std::uint32_t> ids;

  tree::BinaryTree join(std::size_t primitive_count, Executor& executor) const {
    return tree::join_pieces({top.data(), top.size()}, 0, ids.span(), primitive_count, executor);
  }
};

template <class Finder>
concept MakesSubtrees = requires(Finder finder, const BuildRange& range) {
  finder.finishes(range);
};

struct TopDownSizes {
  std::size_t large_range = kLargeRange;  ///< ranges of more references are worked on by all threads
  std::size_t task_range = kTaskRange;    ///< ranges of up to so many are finished by one thread
  std::size_t parts = 1;                  ///< references in leaves that each of the finder's may stand for
};

template <class Finder>
class TopDownDriver {
 public:
  TopDownDriver(Finder& finder, std::size_t reference_count, const BuildContext& context,
                const TopDownSizes& sizes = {})
      : finder_(finder), executor_(context.executor), monitor_(context, reference_count), sizes_(sizes) {
    pieces_.nodes = AlignedBuffer<tree::Node>(2 * sizes.parts * reference_count);
    pieces_.ids = AlignedBuffer<std::uint32_t>(sizes.parts * reference_count);
  }

  /// Fills pieces(). False when cancelled.
  bool run(BuildRange root) {
    std::vector<BuildRange> large, small;
    pieces_.top.push_back({});
    root.slot = 0;
    (root.size() > sizes_.task_range ? large : small).push_back(root);
    while (!large.empty() && !monitor_.cancelled()) large = split_round(large, small);
    executor_.for_chunks(small.size(), 1, [&](std::size_t chunk, std::size_t, std::size_t) {
      finish(small[chunk]);
      monitor_.finish(small[chunk].size());
    });
    return !monitor_.cancelled();
  }

  TreePieces& pieces() { return pieces_; }

 private:
  /// Below this many ranges at once the threads share the work on each large range, from here on the ranges.
  static constexpr std::size_t kManyRanges = 8;
  /// Ranges of a piece that wait: one for each level, to the depth limit and the halves past it.
  static constexpr std::size_t kMostWaiting = kDepthLimit + 32;

  struct Children {
    bool split = false;
    BuildRange left, right;
  };

  /// The slots of ranges worth a task are the numbers of their top nodes.
  std::vector<BuildRange> split_round(const std::vector<BuildRange>& ranges, std::vector<BuildRange>& small) {
    std::vector<Children> children(ranges.size());
    const auto by_all_threads = [&](const BuildRange& range) {
      return ranges.size() < kManyRanges && range.size() > sizes_.large_range;
    };
    for (std::size_t i = 0; i < ranges.size(); ++i)
      if (by_all_threads(ranges[i]))
        children[i].split = split(ranges[i], executor_, children[i].left, children[i].right);
    executor_.for_chunks(ranges.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      SequentialExecutor sequential;
      if (!by_all_threads(ranges[i]))
        children[i].split = split(ranges[i], sequential, children[i].left, children[i].right);
      if (!children[i].split) Piece(*this, ranges[i]).leaf();
    });
    std::vector<BuildRange> large;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      if (!children[i].split) {
        monitor_.finish(ranges[i].size());
        continue;
      }
      children[i].left.slot = std::uint32_t(pieces_.top.size());
      children[i].right.slot = children[i].left.slot + 1;
      pieces_.top.resize(pieces_.top.size() + 2);
      tree::TopNode& parent = pieces_.top[ranges[i].slot];
      parent.root.bounds = ranges[i].bounds.box();
      parent.left = children[i].left.slot;
      parent.right = children[i].right.slot;
      for (const BuildRange& child : {children[i].left, children[i].right})
        (child.size() > sizes_.task_range ? large : small).push_back(child);
    }
    return large;
  }

  /// The piece below a top node while it is made: places of the range's references are its own.
  class Piece {
   public:
    Piece(TopDownDriver& driver, const BuildRange& range)
        : driver_(driver),
          top_(driver.pieces_.top[range.slot]),
          root_(range),
          first_id_(static_cast<std::uint32_t>(driver.sizes_.parts * range.first)),
          cursor_{driver.pieces_.nodes.data() + 2 * std::size_t{first_id_}, driver.pieces_.ids.data(), 2, first_id_} {
      root_.slot = 0;
    }
    ~Piece() {
      top_.root = cursor_.nodes[0];
      top_.inner = cursor_.next_node / 2 - 1;
      top_.pairs = cursor_.nodes + 2;
      top_.first_reference = first_id_;
      top_.reference_count = cursor_.next_id - first_id_;
    }
    Piece(const Piece&) = delete;
    Piece& operator=(const Piece&) = delete;

    void leaf() { driver_.leaf(root_, cursor_); }
    void subtree() {
      std::array<BuildRange, kMostWaiting> stack;
      std::size_t waiting = 0;
      SequentialExecutor sequential;
      BuildRange range = root_, left, right;
      while (!driver_.monitor_.cancelled()) {
        if (driver_.split(range, sequential, left, right)) {
          left.slot = cursor_.take_pair();
          right.slot = left.slot + 1;
          cursor_.nodes[range.slot] = {range.bounds.box(), left.slot, 0};
          stack[waiting++] = right;
          range = left;
        } else {
          driver_.leaf(range, cursor_);
          if (waiting == 0) return;
          range = stack[--waiting];
        }
      }
    }

   private:
    TopDownDriver& driver_;
    tree::TopNode& top_;
    BuildRange root_;
    std::uint32_t first_id_;
    SubtreeCursor cursor_;
  };

  void finish(const BuildRange& range) { Piece(*this, range).subtree(); }

  /// True when the range was split, false when a leaf is to be made of it, or what the finder makes.
  bool split(const BuildRange& range, Executor& executor, BuildRange& left, BuildRange& right) {
    if (is_finished(range)) return false;
    const auto split = range.depth < kDepthLimit ? finder_.find(range, executor) : finder_.median(range);
    if (split.is_leaf()) return false;
    finder_.apply(split, range, executor, left, right);
    left.depth = right.depth = range.depth + 1;
    return true;
  }

  void leaf(const BuildRange& range, SubtreeCursor& cursor) {
    if constexpr (MakesSubtrees<Finder>) {
      finder_.finish(range, cursor);
    } else {
      finder_.write_leaf(range, cursor.ids + cursor.next_id);
      cursor.nodes[range.slot] = {range.bounds.box(), cursor.next_id, range.size()};
      cursor.next_id += range.size();
    }
  }

  bool is_finished(const BuildRange& range) const {
    if constexpr (MakesSubtrees<Finder>) return finder_.finishes(range);
    return range.size() <= 1;
  }

  Finder& finder_;
  Executor& executor_;
  BuildMonitor monitor_;
  TopDownSizes sizes_;
  TreePieces pieces_;
};

/// The tree of `set` that a finder which owns its references makes. `make_finder(ReferenceSet&&)` returns the finder;
/// its `root(Executor&)` is the range of all references.
template <class MakeFinder>
Result<tree::BinaryTree> build_top_down(refs::ReferenceSet&& set, const BuildContext& context,
                                        const MakeFinder& make_finder, std::size_t large_range = kLargeRange) {
  const std::size_t count = set.references.size();
  const std::size_t primitive_count = set.primitive_count;
  TreePieces pieces;
  {
    auto finder = make_finder(std::move(set));
    TopDownDriver<decltype(finder)> driver(finder, count, context, {.large_range = large_range});
    if (!driver.run(finder.root(context.executor))) return cancelled_error();
    pieces = std::move(driver.pieces());
  }  // the references are no longer needed: their memory goes before the tree is put together
  return pieces.join(primitive_count, context.executor);
}

}  // namespace boxwood::builders
