// The one entry for mesh files: PLY goes to our own reader, everything else to assimp.
#include "boxwood/io.h"
#include "io/ending.h"
#include "io/file_reader.h"
#include "io/ply_header.h"
#include "io/read_ply.h"
#include "io/read_with_assimp.h"
#include "io/sentence.h"

namespace boxwood::io {
namespace {

bool is_ply(FileReader& file, const std::filesystem::path& path) {
  if (file.prepare(4) && begins_like_ply({reinterpret_cast<const char*>(file.data()), 4})) return true;
  return ending_of(path) == ".ply";
}

Result<LoadedMesh> read(const std::filesystem::path& path) {
  Result<FileReader> file = FileReader::open(path);
  if (!file) return file.error();
  if (!file->prepare(1)) {
    if (file->system_error()) return Error(read_error(path, file->system_error()));
    return Error(read_error(ErrorCode::malformed, path, "it is empty"));
  }
  if (is_ply(*file, path)) return read_ply(*file, path);
  if (!file->is_regular())
    return Error(read_error(ErrorCode::unsupported, path, "only PLY can be read from a pipe or device"));
  return read_with_assimp(*file, path);
}

}  // namespace

Result<LoadedMesh> read_mesh(const std::filesystem::path& path) {
  return guard_memory("read", path, [&] {
    Result<LoadedMesh> loaded = read(path);
    if (loaded) loaded->mesh.name = path.filename().string();
    return loaded;
  });
}

}  // namespace boxwood::io
