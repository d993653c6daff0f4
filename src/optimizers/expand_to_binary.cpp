// A wide tree back to a binary one. The children of a wide node are merged pair by pair, always the two whose common
// box is smallest; a leaf is split down to single references where the surface area cost of its halves is least (sweep
// over all three axes), since where leaves end is for the next collapse to decide. What a binary tree had above the
// wide tree is so found again up to what the collapse has left open. O(n log n) for leaves of bounded size,
// deterministic: ties go to the lower place; any depth.
#include <algorithm>
#include <new>
#include <string>

#include "boxwood/optimizers.h"

namespace boxwood::optimizers {
namespace {

/// Leaves of more references (layout `linear` has them) are halved at the median instead of swept.
constexpr std::size_t kMostSwept = 256;

struct Item {
  Box box;
  std::uint32_t primitive;
};

class Expander {
 public:
  Expander(const tree::WideTree& wide, std::span<const Box> boxes, bool splits_leaves)
      : wide_(wide), boxes_(boxes), splits_leaves_(splits_leaves) {}

  void run() {
    nodes_.reserve(2 * wide_.references.size());
    references_.reserve(wide_.references.size());
    nodes_.push_back({wide_.bounds, 0, 0});
    slot_.assign(wide_.first_child.size() - 1, 0);
    for (std::size_t n = 0; n < slot_.size(); ++n) expand_node(n);
  }
  std::span<const tree::Node> nodes() const { return nodes_; }
  std::span<const std::uint32_t> references() const { return references_; }

 private:
  std::uint32_t add_pair() {
    nodes_.resize(nodes_.size() + 2);
    return std::uint32_t(nodes_.size() - 2);
  }

  /// Merges the children of a wide node below its binary node.
  void expand_node(std::size_t n) {
    struct Part {
      Box box;
      std::uint32_t child, left, right;  // child: of the wide tree, or kMerged
    };
    constexpr std::uint32_t kMerged = 0xffffffffu;
    const std::uint32_t first = wide_.first_child[n], count = wide_.first_child[n + 1] - first;
    std::vector<Part> parts;
    std::vector<std::uint32_t> open;
    for (std::uint32_t i = 0; i < count; ++i) {
      parts.push_back({wide_.children[first + i].bounds, first + i, 0, 0});
      open.push_back(i);
    }
    while (open.size() > 1) {
      std::size_t a = 0, b = 1;
      float least = kInfinity;
      for (std::size_t i = 0; i < open.size(); ++i)
        for (std::size_t j = i + 1; j < open.size(); ++j) {
          const float area = merge(parts[open[i]].box, parts[open[j]].box).half_area();
          if (area < least) least = area, a = i, b = j;
        }
      parts.push_back({merge(parts[open[a]].box, parts[open[b]].box), kMerged, open[a], open[b]});
      open[a] = std::uint32_t(parts.size() - 1);
      open.erase(open.begin() + std::ptrdiff_t(b));
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pending{{open[0], slot_[n]}};  // part, binary node
    while (!pending.empty()) {
      const auto [p, node] = pending.back();
      pending.pop_back();
      const Part& part = parts[p];
      if (part.child != kMerged) {
        place_child(wide_.children[part.child], node);
        continue;
      }
      const std::uint32_t pair = add_pair();
      nodes_[node] = {part.box, pair, 0};
      pending.push_back({part.right, pair + 1});
      pending.push_back({part.left, pair});
    }
  }

  void place_child(const tree::WideTree::Child& child, std::uint32_t node) {
    if (child.count == 0) {
      slot_[child.first] = node;
    } else if (splits_leaves_) {
      split_leaf(child, node);
    } else {
      nodes_[node] = {child.bounds, std::uint32_t(references_.size()), child.count};
      const auto first = wide_.references.begin() + std::ptrdiff_t(child.first);
      references_.insert(references_.end(), first, first + std::ptrdiff_t(child.count));
    }
  }

  void split_leaf(const tree::WideTree::Child& child, std::uint32_t root) {
    items_.clear();
    for (std::uint32_t i = child.first; i < child.first + child.count; ++i)
      items_.push_back({boxes_[i], wide_.references[i]});
    struct Range {
      std::uint32_t node;
      std::size_t begin, end;
    };
    std::vector<Range> pending{{root, 0, items_.size()}};
    while (!pending.empty()) {
      const auto [node, begin, end] = pending.back();
      pending.pop_back();
      Box box;
      for (std::size_t i = begin; i < end; ++i) box.grow(items_[i].box);
      if (node == root) box = child.bounds;
      if (end - begin == 1) {
        nodes_[node] = {box, std::uint32_t(references_.size()), 1};
        references_.push_back(items_[begin].primitive);
        continue;
      }
      const std::size_t middle = split(begin, end, box);
      const std::uint32_t pair = add_pair();
      nodes_[node] = {box, pair, 0};
      pending.push_back({pair + 1, middle, end});
      pending.push_back({pair, begin, middle});
    }
  }

  void sort(std::size_t begin, std::size_t end, int axis) {
    std::sort(items_.begin() + std::ptrdiff_t(begin), items_.begin() + std::ptrdiff_t(end),
              [&](const Item& a, const Item& b) {
                const float x = a.box.lower[axis] + a.box.upper[axis], y = b.box.lower[axis] + b.box.upper[axis];
                return x != y ? x < y : a.primitive < b.primitive;
              });
  }

  /// Puts the items into the order of the best axis and says where to cut.
  std::size_t split(std::size_t begin, std::size_t end, const Box& box) {
    if (end - begin > kMostSwept) {
      sort(begin, end, box.widest_axis());
      return begin + (end - begin) / 2;
    }
    int best_axis = 0;
    std::size_t best = begin + (end - begin) / 2;
    float least = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      sort(begin, end, axis);
      Box right;
      right_.resize(end - begin);
      for (std::size_t i = end; i-- > begin;) right.grow(items_[i].box), right_[i - begin] = right.half_area();
      Box left;
      for (std::size_t i = begin + 1; i < end; ++i) {
        left.grow(items_[i - 1].box);
        const float cost = left.half_area() * float(i - begin) + right_[i - begin] * float(end - i);
        if (cost < least) least = cost, best = i, best_axis = axis;
      }
    }
    if (best_axis != 2) sort(begin, end, best_axis);
    return best;
  }

  const tree::WideTree& wide_;
  std::span<const Box> boxes_;
  bool splits_leaves_;
  std::vector<tree::Node> nodes_;
  std::vector<std::uint32_t> references_, slot_;  // slot: binary node of each wide one
  std::vector<Item> items_;
  std::vector<float> right_;
};

}  // namespace

Result<tree::BinaryTree> expand_to_binary(const tree::WideTree& wide, std::span<const Box> reference_boxes,
                                          std::size_t primitive_count, bool splits_references, Executor& executor,
                                          bool splits_leaves) try {
  if (reference_boxes.size() != wide.references.size())
    return Error{ErrorCode::invalid_argument, "the wide tree has " + std::to_string(wide.references.size()) +
                                                  " references but there are boxes of " +
                                                  std::to_string(reference_boxes.size())};
  if (wide.children.empty()) {
    tree::BinaryTree empty;
    empty.primitive_count = primitive_count;
    return empty;
  }
  Expander expander(wide, reference_boxes, splits_leaves);
  expander.run();
  return tree::canonicalize(expander.nodes(), expander.references(), primitive_count, splits_references, executor);
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::out_of_memory,
               "not enough memory to expand a wide tree of " + std::to_string(wide.references.size()) + " references"};
}

}  // namespace boxwood::optimizers
