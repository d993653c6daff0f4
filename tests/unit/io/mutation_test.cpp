// Files with flipped, lost and doubled bytes. Whatever comes back, nothing may crash, and what is read must be sound.
// The mutations come from a fixed generator, so a failure names a file that can be made again.
#include "support/effort.h"
#include "unit/io/scene_file_builder.h"

namespace boxwood::io::test {
namespace {

class Mutations : public InFolder {
 protected:
  // One to four changes at random places.
  std::string mutate(std::string bytes) {
    for (std::uint32_t changes = 1 + random() % 4; changes && !bytes.empty(); --changes) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 6) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes[at] = static_cast<char>(bytes[at] ^ (1u << random() % 8));
          break;
        case 2:
          bytes[at] = random() % 2 ? '\xff' : '\0';
          break;
        case 3:
          bytes.erase(at, 1 + random() % 8);
          break;
        case 4:
          bytes.insert(at, bytes.substr(random() % bytes.size(), 1 + random() % 16));
          break;
        default:
          bytes[at] = static_cast<char>('0' + random() % 10);
          break;
      }
    }
    return bytes;
  }

  void expect_sound_meshes(const std::string& name, const std::string& original, std::size_t count) {
    ASSERT_TRUE(read_mesh(file(name, original))) << "the original itself";
    for (std::size_t i = 0; i < count; ++i) {
      SCOPED_TRACE(name + ", mutation " + std::to_string(i));
      const auto loaded = read_mesh(file(name, mutate(original)));
      if (!loaded) {
        EXPECT_EQ(loaded.error().message.find_first_of("\r\n"), std::string::npos);
        EXPECT_NE(loaded.error().message.find(name), std::string::npos);
        continue;
      }
      EXPECT_FALSE(loaded->mesh.triangles.empty());
      for (const auto& triangle : loaded->mesh.triangles)
        for (const std::uint32_t corner : triangle) ASSERT_LT(corner, loaded->mesh.vertices.size());
    }
  }

 private:
  std::uint32_t random() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::uint32_t>(state_ >> 33);
  }
  std::uint64_t state_ = 20250101;
};

const std::string kPlyHeader =
    " 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\nproperty list uchar int "
    "t\n"
    "element face 3\nproperty list uchar int vertex_indices\nproperty uchar c\nend_header\n";

TEST_F(Mutations, AsciiPly) {
  expect_sound_meshes("a.ply",
                      "ply\nformat ascii" + kPlyHeader +
                          "0 0 0 0\n1 0 0 1 7\n0 1.5e0 0 0\n0 0 -1 0\n3 0 1 2 9\n3 0 1 3 9\n4 0 2 3 1 9\n",
                      3000);
}

TEST_F(Mutations, BinaryPly) {
  for (const bool big : {false, true}) {
    std::string text = "ply\nformat binary_" + std::string(big ? "big" : "little") + "_endian" + kPlyHeader;
    for (int i = 0; i < 4; ++i)
      text +=
          bytes_of(1.f * static_cast<float>(i), big) + bytes_of(0.5, big) + bytes_of(0.f, big) + std::string(1, '\0');
    for (int i = 0; i < 3; ++i)
      text += '\3' + bytes_of(i, big) + bytes_of((i + 1) % 4, big) + bytes_of((i + 2) % 4, big) + 'c';
    expect_sound_meshes(big ? "big.ply" : "little.ply", text, 3000);
  }
}

TEST_F(Mutations, Obj) {
  expect_sound_meshes("a.obj",
                      "# comment\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\no one\nusemtl m\n"
                      "f 1 2 3\nf 1/1/1 2/1/1 4/1/1\ng two\nf -4//1 -3//1 -2//1\nl 1 2\nf 1 2 3 4\n",
                      boxwood::test::effort(500, 4));
}

TEST_F(Mutations, AsciiStl) {
  expect_sound_meshes("a.stl",
                      "solid one\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1.5 0\nendloop\n"
                      "endfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1e-3\nendloop\n"
                      "endfacet\nendsolid one\n",
                      boxwood::test::effort(500, 4));
}

TEST_F(Mutations, BinaryStl) {
  const Corners corners{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  expect_sound_meshes("b.stl", binary_stl({corners, corners, corners}), 500);
}

TEST_F(Mutations, Gltf) {
  expect_sound_meshes("a.gltf", GltfScene().gltf(), 500);
}

TEST_F(Mutations, Glb) {
  expect_sound_meshes("a.glb", GltfScene().glb(), 500);
}

TEST_F(Mutations, Npy) {
  ASSERT_TRUE(write_rays(folder_ / "a.npy", std::vector<Ray>(3)));
  const std::string original = content_of(folder_ / "a.npy");
  int readable = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto rays = read_rays(file("b.npy", mutate(original)));
    if (rays) {
      ++readable;
      EXPECT_LE(rays->size(), original.size());
    } else {
      EXPECT_EQ(rays.error().message.find_first_of("\r\n"), std::string::npos);
    }
  }
  EXPECT_GT(readable, 0) << "changed values are fine";
}

}  // namespace
}  // namespace boxwood::io::test
