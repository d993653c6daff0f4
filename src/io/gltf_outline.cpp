// glTF 2.0 (Khronos 2017). Iterative throughout: nodes are visited in topological order, so cycles, deep chains and
// meshes used exponentially often are seen before anyone recurses into them. O(nodes + primitives).
#include "io/gltf_outline.h"

#include <algorithm>
#include <cstring>

#include "io/ending.h"
#include "io/json.h"
#include "io/sentence.h"

namespace boxwood::io {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kDeepestNode = 1000;     // assimp recurses along nodes; it survives some ten thousand
constexpr std::uint64_t kMostUses = 10'000'000;  // nodes with each path to them counted
constexpr std::uint64_t kMissing = ~std::uint64_t{0};

Result<std::string> read_bytes(FileReader& file, std::uint64_t size, const std::filesystem::path& path) {
  std::string text;
  text.reserve(size);
  while (text.size() < size && file.prepare(1)) {
    const std::size_t part = std::min<std::uint64_t>(file.available(), size - text.size());
    text.append(reinterpret_cast<const char*>(file.data()), part);
    file.consume(part);
  }
  if (file.system_error()) return Result<std::string>(read_error(path, file.system_error()));
  return text;
}

std::uint32_t word_at(FileReader& file, std::size_t offset) {
  const unsigned char* b = file.data() + offset;
  return b[0] | b[1] << 8 | b[2] << 16 | static_cast<std::uint32_t>(b[3]) << 24;
}

// The JSON text of either form; empty for what is not glTF 2.
Result<std::string> read_text(FileReader& file, const std::filesystem::path& path) {
  const std::uint64_t size = file.bytes_left().value_or(0);
  const bool binary = file.prepare(4) && std::memcmp(file.data(), "glTF", 4) == 0;
  if (!binary) {
    if (!file.prepare(1) || ending_of(path) == ".glb") return std::string();
    return read_bytes(file, size, path);
  }
  const auto truncated = [&](const std::string& what, std::uint64_t needed) -> Error {
    return read_error(ErrorCode::malformed, path,
                      "it is truncated: " + what + " needs " + std::to_string(needed) + " bytes and the file has " +
                          std::to_string(size));
  };
  if (!file.prepare(20)) return truncated("the header", 20);
  if (word_at(file, 4) != 2) return std::string();
  if (word_at(file, 8) > size) return truncated("the whole", word_at(file, 8));
  const std::uint64_t json_size = word_at(file, 12);
  if (20 + json_size > size) return truncated("the description", 20 + json_size);
  file.consume(20);
  return read_bytes(file, json_size, path);
}

class Outline {
 public:
  Outline(const Json& root, const std::filesystem::path& path) : root_(root), path_(path) {}

  Result<std::optional<GltfOutline>> make() {
    for (const Json& extension : json_array(root_, "extensionsRequired"))
      if (extension == "EXT_meshopt_compression" || extension == "EXT_mesh_gpu_instancing")
        return Error(read_error(ErrorCode::unsupported, path_,
                                "it needs the glTF extension " + one_line(extension.get<std::string>())));
    const auto& nodes = json_array(root_, "nodes");
    uses_.assign(nodes.size(), 0);
    if (Status status = count_uses(nodes); !status) return status.error();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::uint64_t triangles = uses_[i] ? triangles_of_mesh(json_integer(nodes[i], "mesh", kMissing)) : 0;
      outline_.triangles += std::min(triangles, std::uint64_t{1} << 32) * uses_[i];
    }
    follow_order(nodes);
    return std::optional(outline_);
  }

 private:
  const Json& roots() const {
    const auto& scenes = json_array(root_, "scenes");
    const std::uint64_t scene = json_integer(root_, "scene", 0);
    static const Json kNone = Json::array();
    return scene < scenes.size() ? json_array(scenes[scene], "nodes") : kNone;
  }

  // Topological order (Kahn 1962): a node is done when all its parents are.
  Status count_uses(const Json& nodes) {
    std::vector<std::uint32_t> parents(nodes.size(), 0), depth(nodes.size(), 0);
    const auto for_each_child = [&](std::size_t node, auto&& visit) {
      for (const Json& child : json_array(nodes[node], "children"))
        if (const std::uint64_t c = json_integer(child, kMissing); c < nodes.size()) visit(c);
    };
    for (const Json& root : roots())
      if (const std::uint64_t r = json_integer(root, kMissing); r < nodes.size()) ++uses_[r];
    for (std::size_t i = 0; i < nodes.size(); ++i) for_each_child(i, [&](std::uint64_t c) { ++parents[c]; });
    std::vector<std::size_t> ready;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (parents[i] == 0) ready.push_back(i);
    std::size_t done = 0;
    std::uint64_t all_uses = 0;
    for (; !ready.empty(); ++done) {
      const std::size_t node = ready.back();
      ready.pop_back();
      all_uses += uses_[node];
      if (depth[node] > kDeepestNode)
        return read_error(ErrorCode::unsupported, path_, "its nodes are nested deeper than 1000 levels");
      if (all_uses > kMostUses)
        return read_error(ErrorCode::too_large, path_, "its nodes stand for more than ten million instances");
      for_each_child(node, [&](std::uint64_t c) {
        uses_[c] = std::min(uses_[c] + uses_[node], kMostUses + 1);
        depth[c] = std::max(depth[c], depth[node] + 1);
        if (--parents[c] == 0) ready.push_back(c);
      });
    }
    if (done == nodes.size()) return {};
    const auto in_cycle = std::find_if(parents.begin(), parents.end(), [](std::uint32_t n) { return n != 0; });
    return read_error(ErrorCode::malformed, path_,
                      "its node " + std::to_string(in_cycle - parents.begin()) +
                          " is, or hangs from, a node that is its own ancestor");
  }

  std::uint64_t triangles_of_mesh(std::uint64_t mesh) const {
    const auto& meshes = json_array(root_, "meshes");
    if (mesh >= meshes.size()) return 0;
    std::uint64_t sum = 0;
    for (const Json& primitive : json_array(meshes[mesh], "primitives")) sum += triangles_of(primitive);
    return sum;
  }

  std::uint64_t triangles_of(const Json& primitive) const {
    const auto attributes = primitive.is_object() ? primitive.find("attributes") : primitive.end();
    const std::uint64_t positions =
        attributes != primitive.end() ? json_integer(*attributes, "POSITION", kMissing) : kMissing;
    const std::uint64_t accessor = json_integer(primitive, "indices", positions);
    const auto& accessors = json_array(root_, "accessors");
    if (positions >= accessors.size() || accessor >= accessors.size()) return 0;
    const std::uint64_t corners = json_integer(accessors[accessor], "count", 0);
    switch (json_integer(primitive, "mode", 4)) {
      case 4:
        return corners / 3;
      case 5:
      case 6:
        return corners > 2 ? corners - 2 : 0;
      default:
        return 0;
    }
  }

  void follow_order(const Json& nodes) {
    std::vector<std::uint64_t> stack;
    const auto push = [&](const Json& children) {
      for (std::size_t i = children.size(); i-- > 0;)
        if (const std::uint64_t c = json_integer(children[i], kMissing); c < nodes.size()) stack.push_back(c);
    };
    push(roots());
    for (std::uint64_t least = 0; !stack.empty();) {
      const Json& node = nodes[stack.back()];
      stack.pop_back();
      if (const std::uint64_t mesh = json_integer(node, "mesh", kMissing); mesh != kMissing) {
        if (mesh < least) outline_.keeps_file_order = false;
        least = std::max(least, mesh + 1);
      }
      push(json_array(node, "children"));
    }
  }

  const Json& root_;
  const std::filesystem::path& path_;
  GltfOutline outline_;
  std::vector<std::uint64_t> uses_;
};

}  // namespace

Result<std::optional<GltfOutline>> read_gltf_outline(FileReader& file, const std::filesystem::path& path) {
  const Result<std::string> text = read_text(file, path);
  if (!text) return text.error();
  if (text->empty()) return std::optional<GltfOutline>();
  const Result<Json> root = parse_json(*text);
  if (!root) return Error(read_error(root.error().code, path, root.error().message));
  if (!root->is_object() || !root->contains("asset") || !json_string(root->at("asset"), "version").starts_with("2"))
    return std::optional<GltfOutline>();
  return Outline(*root, path).make();
}

}  // namespace boxwood::io
