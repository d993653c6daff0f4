// Mesh files through assimp, without any of its post-processing steps: those join, split, drop or reorder triangles.
// Polygons are cut here, and the tree of nodes is flattened here, depth first, with transforms multiplied in double
// precision and each vertex rounded once. O(triangles); no recursion of ours.
#include "io/read_with_assimp.h"

#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstring>
#include <optional>
#include <string_view>

#include "io/ending.h"
#include "io/gltf_outline.h"
#include "io/obj_order.h"
#include "io/sentence.h"
#include "io/stl_check.h"

namespace boxwood::io {
namespace {

constexpr std::uint64_t kMostEntries = 0x7fffffff;  // vertices and triangles, as mesh::check_indices wants

// An affine map in double precision, row by row; the default is the identity.
struct Transform {
  double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  // Kept apart because a product with the identity is not the identity for infinite coordinates (0 * inf is NaN).
  bool is_identity = true;

  Vec3 apply(const aiVector3D& p) const {
    if (is_identity) return {p.x, p.y, p.z};
    Vec3 q;
    for (int i = 0; i < 3; ++i) q[i] = static_cast<float>(m[i][0] * p.x + m[i][1] * p.y + m[i][2] * p.z + m[i][3]);
    return q;
  }
};

// The parent's map after the node's own.
Transform compose(const Transform& parent, const aiMatrix4x4& own) {
  if (own == aiMatrix4x4()) return parent;  // exactly; its IsIdentity() rounds small transforms away
  Transform result;
  result.is_identity = false;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) {
      double sum = j == 3 ? parent.m[i][3] : 0;
      for (int k = 0; k < 3; ++k) sum += parent.m[i][k] * own[static_cast<unsigned>(k)][static_cast<unsigned>(j)];
      result.m[i][j] = sum;
    }
  return result;
}

struct Instance {
  unsigned mesh = 0;
  Transform transform;
};

// The root's own map. assimp's Collada reader puts the file's unit of length there, as a factor, and nothing else while
// axes are left alone; units are to stay untouched.
aiMatrix4x4 root_transform(const aiScene& scene) {
  aiString format;
  const bool is_collada = scene.mMetaData && scene.mMetaData->Get(AI_METADATA_SOURCE_FORMAT, format) &&
                          std::string_view(format.C_Str()).starts_with("Collada");
  return is_collada ? aiMatrix4x4() : scene.mRootNode->mTransformation;
}

// All uses of meshes in the tree of nodes, depth first, children in their order.
std::vector<Instance> instances_of(const aiScene& scene) {
  std::vector<Instance> instances;
  std::vector<std::pair<const aiNode*, Transform>> stack;
  if (scene.mRootNode) stack.push_back({scene.mRootNode, {}});
  while (!stack.empty()) {
    const auto [node, parent] = stack.back();
    stack.pop_back();
    const bool is_root = node == scene.mRootNode;
    const Transform transform = compose(parent, is_root ? root_transform(scene) : node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; ++i)
      if (node->mMeshes[i] < scene.mNumMeshes) instances.push_back({node->mMeshes[i], transform});
    for (unsigned i = node->mNumChildren; i-- > 0;)
      if (node->mChildren[i]) stack.push_back({node->mChildren[i], transform});
  }
  return instances;
}

struct Counts {
  std::uint64_t vertices = 0, triangles = 0, polygons = 0, skipped = 0;
};

Counts count(const aiMesh& mesh) {
  Counts counts;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const unsigned corners = mesh.mFaces[i].mNumIndices;
    counts.triangles += corners > 2 ? corners - 2 : 0;
    counts.polygons += corners > 3;
    counts.skipped += corners < 3;
  }
  if (counts.triangles) counts.vertices = mesh.mNumVertices;
  return counts;
}

Status append(const aiMesh& source, const Instance& instance, const std::filesystem::path& path, TriangleMesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (unsigned i = 0; i < source.mNumVertices; ++i)
    mesh.vertices.push_back(instance.transform.apply(source.mVertices[i]));
  for (unsigned i = 0; i < source.mNumFaces; ++i) {
    const aiFace& face = source.mFaces[i];
    for (unsigned k = 0; k < face.mNumIndices; ++k)
      if (face.mIndices[k] >= source.mNumVertices)
        return read_error(ErrorCode::malformed, path,
                          "face " + std::to_string(i) + " of its part " + std::to_string(instance.mesh) +
                              " refers to vertex " + std::to_string(face.mIndices[k]) + ", there are " +
                              std::to_string(source.mNumVertices) + " (counted from 0)");
    for (unsigned k = 2; k < face.mNumIndices; ++k)
      mesh.triangles.push_back({base + face.mIndices[0], base + face.mIndices[k - 1], base + face.mIndices[k]});
  }
  return {};
}

Result<LoadedMesh> flatten(const aiScene& scene, const std::vector<Instance>& instances,
                           const std::filesystem::path& path) {
  std::vector<Counts> counts(scene.mNumMeshes);
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) counts[i] = count(*scene.mMeshes[i]);
  Counts sum;
  for (const Instance& instance : instances) {
    const Counts& c = counts[instance.mesh];
    sum = {sum.vertices + c.vertices, sum.triangles + c.triangles, sum.polygons + c.polygons, sum.skipped + c.skipped};
  }
  if (sum.triangles > kMostEntries || sum.vertices > kMostEntries)
    return Error(read_error(ErrorCode::too_large, path,
                            "it has " + std::to_string(sum.triangles) + " triangles and " +
                                std::to_string(sum.vertices) + " vertices, and 2^31 - 1 of each are the limit"));
  LoadedMesh loaded;
  loaded.polygons_triangulated = sum.polygons;
  loaded.lines_and_points_skipped = sum.skipped;
  loaded.mesh.vertices.reserve(sum.vertices);
  loaded.mesh.triangles.reserve(sum.triangles);
  for (const Instance& instance : instances) {
    if (counts[instance.mesh].triangles == 0) continue;
    if (Status status = append(*scene.mMeshes[instance.mesh], instance, path, loaded.mesh); !status)
      return status.error();
  }
  return loaded;
}

// assimp keeps exceptions to itself; a failed allocation must still come out as one.
void rethrow_bad_alloc(const std::exception_ptr& exception) {
  if (!exception) return;
  try {
    std::rethrow_exception(exception);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {  // any other is told through its message
  }
}

Error import_error(const std::filesystem::path& path, const std::string& message) {
  if (message.starts_with("No suitable reader found"))
    return read_error(ErrorCode::unsupported, path, "neither its content nor its ending is of a known mesh format");
  return read_error(ErrorCode::malformed, path, "assimp says: " + one_line(message));
}

Result<const aiScene*> import(Assimp::Importer& importer, const std::filesystem::path& path) {
  // Only triangles are wanted; less to read is less to go wrong.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_MATERIALS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // Coordinates as they stand in the file, whichever axis is up: no other format is turned either.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  try {
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    if (scene) return scene;
    rethrow_bad_alloc(importer.GetException());
    return import_error(path, importer.GetErrorString());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& exception) {
    return import_error(path, exception.what());
  }
}

// Ids follow the file when each mesh is used once, in order; formats that assimp regroups need a note of their own.
void judge_order(const aiScene& scene, const std::vector<Instance>& instances, const std::string& ending,
                 LoadedMesh& loaded) {
  bool in_order = instances.size() == scene.mNumMeshes;
  for (std::size_t i = 0; in_order && i < instances.size(); ++i) in_order = instances[i].mesh == i;
  if (!in_order) {
    loaded.order_note = "the file's nodes use its parts in another order or more than once: ids follow the nodes";
  } else if (scene.mNumMeshes > 1 && ending != ".stl" && ending != ".obj") {
    loaded.order_note = "assimp read the file as " + std::to_string(scene.mNumMeshes) +
                        " parts and may have grouped its triangles by material: ids follow the parts";
  }
  loaded.keeps_file_order = loaded.order_note.empty();
}

Status check_before(FileReader& file, const std::filesystem::path& path, const std::string& ending,
                    std::optional<GltfOutline>& outline, std::string& obj_note) {
  const bool is_glb = file.prepare(4) && std::memcmp(file.data(), "glTF", 4) == 0;
  if (is_glb || ending == ".gltf") {
    auto read = read_gltf_outline(file, path);
    if (!read) return read.error();
    outline = *read;
  } else if (ending == ".stl") {
    return check_stl(file, path);
  } else if (ending == ".obj") {
    obj_note = obj_order_note(file);
  }
  return {};
}

}  // namespace

Result<LoadedMesh> read_with_assimp(FileReader& file, const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  std::optional<GltfOutline> outline;
  std::string obj_note;
  if (Status status = check_before(file, path, ending, outline, obj_note); !status) return status.error();
  Assimp::Importer importer;
  const Result<const aiScene*> imported = import(importer, path);
  if (!imported) return imported.error();
  const aiScene& scene = **imported;
  const std::vector<Instance> instances = instances_of(scene);
  Result<LoadedMesh> loaded = flatten(scene, instances, path);
  if (!loaded) return loaded;
  if (outline && outline->triangles != loaded->mesh.triangles.size())
    return Error(read_error(ErrorCode::malformed, path,
                            "it announces " + std::to_string(outline->triangles) + " triangles and only " +
                                std::to_string(loaded->mesh.triangles.size()) +
                                " can be read: the others refer to vertices that do not exist"));
  if (loaded->mesh.triangles.empty())
    return Error(read_error(ErrorCode::malformed, path,
                            std::string(loaded->lines_and_points_skipped ? "it has only lines or points, no triangles"
                                                                         : "it has no triangles") +
                                ", read as " + (ending.empty() ? "what its content looks like" : ending)));
  if (!outline) judge_order(scene, instances, ending, *loaded);
  if (outline && !outline->keeps_file_order)
    loaded->order_note =
        "the scene's nodes use the file's meshes in another order or more than once: ids follow the nodes";
  if (!obj_note.empty()) loaded->order_note = obj_note;
  loaded->keeps_file_order = loaded->order_note.empty();
  return loaded;
}

}  // namespace boxwood::io
