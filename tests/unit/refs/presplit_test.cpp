// Pre-splits against a recursive oracle in exact arithmetic, and what they promise: nothing of a triangle gets lost.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <tuple>

#include "boxwood/refs.h"
#include "support/meshes.h"

namespace boxwood::refs {
namespace {

SequentialExecutor sequential;

struct Split {
  ReferenceSet set;
  PresplitReport report;
};

Split split(const MeshView& mesh, const std::string& text, Executor& executor = sequential) {
  const auto presplit = parse_presplit(text);
  EXPECT_TRUE(presplit) << text;
  auto whole = make_references(mesh, executor);
  EXPECT_TRUE(whole);
  Split result;
  auto set = apply_presplit(std::move(*whole), mesh, *presplit, executor, &result.report);
  EXPECT_TRUE(set) << set.error().message;
  result.set = std::move(*set);
  return result;
}

TriangleMesh moved(TriangleMesh mesh, float scale, Vec3 offset) {
  for (Vec3& v : mesh.vertices) v = v * scale + offset;
  return mesh;
}

TriangleMesh turned(TriangleMesh mesh, Vec3 degrees) {
  mesh::rotate(mesh, degrees, {});
  return mesh;
}

mesh::Scene scene(const char* id, std::size_t triangles, Vec3 degrees = {}) {
  auto made = mesh::make_scene(id, {.triangles = triangles, .rotate = degrees});
  EXPECT_TRUE(made);
  return std::move(*made);
}

TEST(Presplit, TextIsReadAndWritten) {
  const std::pair<const char*, const char*> texts[] = {
      {"none", "none"},
      {"evh", "evh:t=14"},
      {"evh:t=16.5", "evh:t=16.5"},
      {"evh:auto", "evh:auto,budget=1.3,t.most=16"},
      {"evh:auto,budget=1.2", "evh:auto,budget=1.2,t.most=16"},
      {"esc:k=80", "esc:k=80"},
  };
  for (const auto& [given, written] : texts) {
    const auto presplit = parse_presplit(given);
    ASSERT_TRUE(presplit) << given << ": " << presplit.error().message;
    EXPECT_EQ(presplit->text(), written);
    EXPECT_EQ(parse_presplit(written)->text(), written);
  }
  EXPECT_TRUE(Presplit().is_none());
}

TEST(Presplit, ErrorsNameTheValueAndListWhatThereIs) {
  const std::tuple<const char*, ErrorCode, const char*, const char*> cases[] = {
      {"magic", ErrorCode::unknown_name, "'magic'", "evh:auto"},
      {"", ErrorCode::unknown_name, "''", "none"},
      {"evh:k=3", ErrorCode::unknown_name, "'k'", "t"},
      {"evh:t=many", ErrorCode::invalid_argument, "'many'", "number"},
      {"evh:t=", ErrorCode::invalid_argument, "''", "number"},
      {"evh:t=31", ErrorCode::out_of_range, "'31'", "30"},
      {"evh:t=nan", ErrorCode::out_of_range, "'nan'", "30"},
      {"evh:t=1,t=2", ErrorCode::invalid_argument, "'t'", "twice"},
      {"evh:sideways", ErrorCode::invalid_argument, "'sideways'", "evh:auto"},
      {"evh:auto,t=3", ErrorCode::unknown_name, "'t'", "budget"},
      {"evh:", ErrorCode::invalid_argument, "'evh:'", "separator"},
      {"none:t=1", ErrorCode::unknown_name, "'t'", "none"},
      {"esc:k=0", ErrorCode::out_of_range, "'0'", "1"},
  };
  for (const auto& [text, code, value, list] : cases) {
    const auto presplit = parse_presplit(text);
    ASSERT_FALSE(presplit) << text;
    EXPECT_EQ(presplit.error().code, code) << text;
    EXPECT_NE(presplit.error().message.find(value), std::string::npos) << presplit.error().message;
    EXPECT_NE(presplit.error().message.find(list), std::string::npos) << presplit.error().message;
  }
}

TEST(Presplit, NoneLeavesEverythingAsItIs) {
  const TriangleMesh mesh = test::soup(500, 1);
  const auto whole = make_references(mesh, sequential);
  const Split none = split(mesh, "none");
  ASSERT_EQ(none.set.references.size(), 500u);
  EXPECT_EQ(0, std::memcmp(none.set.references.data(), whole->references.data(), whole->references.bytes()));
  EXPECT_EQ(none.report.references_after, 500u);
  EXPECT_EQ(none.report.area_reduction(), 1);
}

TEST(Presplit, PriorityKeepsItsBudgetAndCutsTheLoosestOnly) {
  // Many small triangles and one that lies across them all.
  TriangleMesh mesh = test::soup(400, 7);
  const auto large = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3 v : {Vec3{-50, -40, -45}, Vec3{60, 55, 50}, Vec3{60, 55, 51}}) mesh.vertices.push_back(v);
  mesh.triangles.push_back({large, large + 1, large + 2});
  for (const double budget : {1.0, 1.05, 1.2}) {
    const Split made = split(mesh, "priority:loose=20,budget=" + std::to_string(budget));
    EXPECT_LE(made.set.references.size(), static_cast<std::size_t>(budget * 401));
    for (const Reference& reference : made.set.references) {
      if (reference.primitive == 400) continue;
      EXPECT_EQ(reference.box(), mesh.view().triangle(reference.primitive).bounds());
    }
    EXPECT_EQ(made.report.splits > 0, budget > 1);
    EXPECT_EQ(made.report.area_reduction() < 0.8, budget > 1) << made.report.area_reduction();
  }
}

TEST(Presplit, PriorityLeavesTrianglesThatAreAlikeAlone) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 500; ++i) {
    const float x = static_cast<float>(i);
    for (const Vec3 v : {Vec3{x, x, x}, Vec3{x + 1, x, x + 1}, Vec3{x, x + 1, x + 1}}) mesh.vertices.push_back(v);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_EQ(split(mesh, "priority:budget=4").set.references.size(), 500u);
  EXPECT_GT(split(mesh, "priority:budget=4,loose=0.5").set.references.size(), 900u);
}

/// The heuristic written down again, recursively.
struct Oracle {
  double threshold;
  std::vector<Box> boxes;

  static double volume(Vec3 a, Vec3 b) {
    return std::abs((double(b.x) - a.x) * (double(b.y) - a.y) * (double(b.z) - a.z));
  }
  void cut(std::array<Vec3, 3> corners) {
    std::size_t longest = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (volume(corners[i], corners[(i + 1) % 3]) > volume(corners[longest], corners[(longest + 1) % 3])) longest = i;
    const Vec3 a = corners[longest], b = corners[(longest + 1) % 3], c = corners[(longest + 2) % 3];
    if (volume(a, b) <= threshold) {
      boxes.push_back(Triangle{a, b, c}.bounds());
      return;
    }
    auto first = corners, second = corners;
    first[(longest + 1) % 3] = second[longest] = (a + b) * 0.5f;
    cut(first);
    cut(second);
  }
};

TEST(EdgeVolume, CutsWhereTheOracleCuts) {
  // Corners are multiples of 2^10 below 2^20: a few cuts stay exact in floats.
  test::Random random(7);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 200; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = random.in_cube() * 1024.0f;
      mesh.vertices.push_back(Vec3{std::floor(p.x), std::floor(p.y), std::floor(p.z)} * 1024.0f);
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Box bounds = mesh::bounds(mesh, sequential);
  const Vec3 e = bounds.extent();
  for (const int t : {0, 3, 6, 9}) {
    Oracle oracle{double(e.x) * e.y * e.z / std::exp2(t), {}};
    const Split result = split(mesh, "evh:t=" + std::to_string(t));
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < 200; ++i) {
      oracle.boxes.clear();
      const Triangle triangle = mesh.view().triangle(i);
      oracle.cut({triangle.v0, triangle.v1, triangle.v2});
      for (const Box& box : oracle.boxes) {
        ASSERT_LT(next, result.set.references.size()) << t;
        const Reference& reference = result.set.references[next++];
        ASSERT_EQ(reference.primitive, i);
        ASSERT_TRUE(reference.box().contains(box)) << t;
        ASSERT_TRUE(triangle.bounds().contains(reference.box())) << t;
        const float slack = 64.0f * 0x1p-24f * 0x1p20f;
        const Box loose{box.lower - Vec3{slack, slack, slack}, box.upper + Vec3{slack, slack, slack}};
        ASSERT_TRUE(loose.contains(reference.box())) << t;
      }
    }
    EXPECT_EQ(next, result.set.references.size()) << t;
    EXPECT_EQ(result.report.splits, result.set.references.size() - 200);
  }
}

/// Each random point of each triangle lies in one of its boxes, however inexact the floats are there.
void expect_covered(const TriangleMesh& mesh, const Split& result) {
  test::Random random(3);
  std::size_t begin = 0;
  const auto& references = result.set.references;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::size_t end = begin;
    while (end < references.size() && references[end].primitive == i) ++end;
    ASSERT_GT(end, begin) << i;
    const Triangle t = mesh.view().triangle(i);
    for (std::size_t r = begin; r < end; ++r) ASSERT_TRUE(t.bounds().contains(references[r].box()));
    for (int sample = 0; sample < 40; ++sample) {
      double u = double(random()), v = double(random());
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (sample % 4 == 0) v = 0;  // on an edge
      bool found = false;
      for (std::size_t r = begin; r < end && !found; ++r) {
        found = true;
        for (int axis = 0; axis < 3; ++axis) {
          const double a = t.v0[axis], p = a + u * (t.v1[axis] - a) + v * (t.v2[axis] - a);
          const double slack = 1e-14 * std::abs(a);  // of the point itself
          found &= p >= references[r].lower[axis] - slack && p <= references[r].upper[axis] + slack;
        }
      }
      ASSERT_TRUE(found) << "triangle " << i;
    }
    begin = end;
  }
  EXPECT_EQ(begin, references.size());
}

TEST(Presplit, EveryPointOfATriangleStaysInABox) {
  const TriangleMesh meshes[] = {
      test::soup(300, 1),
      moved(test::soup(300, 2), 1, {1000, -3000, 20}),
      moved(test::soup(300, 3), 1, {1e6f, 1e6f, -1e6f}),  // sixteen floats from end to end
      moved(test::soup(300, 4), 1e-30f, {}),
      moved(test::soup(300, 5), 3e-42f, {}),  // denormals
      moved(test::soup(300, 6), 4e17f, {}),
      turned(test::grid(6), {30, 40, 20}),
  };
  for (std::size_t m = 0; m < std::size(meshes); ++m)
    for (const char* text : {"evh:t=8", "evh:t=14", "evh:auto,budget=3", "evh:clip,t=12", "esc:k=30", "esc:k=1000"}) {
      SCOPED_TRACE(std::string(text) + " on mesh " + std::to_string(m));
      const Split result = split(meshes[m], text);
      expect_covered(meshes[m], result);
      EXPECT_GE(result.set.references.size(), meshes[m].triangles.size());
    }
}

TEST(Presplit, ReportsWhatItDid) {
  const TriangleMesh mesh = turned(test::grid(5), {30, 40, 20});
  for (const char* text : {"evh:t=12", "esc:k=300"}) {
    const Split result = split(mesh, text);
    const PresplitReport& report = result.report;
    EXPECT_EQ(report.references_before, mesh.triangles.size());
    EXPECT_EQ(report.references_after, result.set.references.size());
    EXPECT_GT(report.references_after, report.references_before);
    double before = 0, after = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      before += 2.0 * mesh.view().triangle(i).bounds().half_area();
    for (const Reference& reference : result.set.references) after += 2.0 * reference.box().half_area();
    EXPECT_NEAR(report.area_before / before, 1, 1e-5);
    EXPECT_NEAR(report.area_after / after, 1, 1e-5);
    EXPECT_NEAR(report.area_reduction(), after / before, 1e-5) << text;
    EXPECT_GE(report.best_factor, 0.05);
    EXPECT_LE(report.best_factor, report.average_factor);
    EXPECT_LE(report.average_factor, report.worst_factor);
    EXPECT_LE(report.worst_factor, 1.0);
  }
}

TEST(EdgeVolume, ANeedleIsCutToAQuarterOfItsArea) {
  // Dammertz and Keller's "theoretical maximum": both halves of a diagonal have a quarter of its box's area.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {8, 8, 8}, {8, 8, 8}};
  mesh.triangles = {{0, 1, 2}};
  const Split result = split(mesh, "evh:t=2");
  EXPECT_EQ(result.report.splits, 2u);  // both long sides
  EXPECT_DOUBLE_EQ(result.report.best_factor, 0.25);
  EXPECT_EQ(split(mesh, "evh:t=0").set.references.size(), 1u);
}

TEST(Presplit, ScaleDoesNotMatter) {
  const TriangleMesh mesh = test::soup(400, 8);
  for (const char* text : {"evh:t=10", "evh:auto,budget=1.5", "evh:clip,t=10", "esc:k=100"}) {
    const std::size_t parts = split(mesh, text).set.references.size();
    EXPECT_GT(parts, 400u) << text;
    for (const int exponent : {-60, 20, 57})
      EXPECT_EQ(split(moved(mesh, std::ldexp(1.0f, exponent), {}), text).set.references.size(), parts)
          << text << " at 2^" << exponent;
  }
}

TEST(Presplit, ScenesWithoutVolumeOrAreaStayWhole) {
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}, {0, 2, 1}};
  TriangleMesh point;
  point.vertices = {{3, 4, 5}};
  point.triangles = {{0, 0, 0}};
  for (const char* text : {"evh:t=30", "evh:clip,t=30"})
    EXPECT_EQ(split(test::grid(10), text).set.references.size(), 200u);  // flat
  for (const char* text : {"evh:t=30", "evh:auto", "evh:clip,t=30", "esc:k=1e9"}) {
    EXPECT_EQ(split(line, text).set.references.size(), 2u);
    EXPECT_EQ(split(point, text).set.references.size(), 1u);
    EXPECT_EQ(split(MeshView{}, text).set.references.size(), 0u);
  }
}

TEST(EdgeVolume, LeavesScansAloneAndSplitsTurnedArchitecture) {
  for (const char* text : {"evh", "evh:clip"}) {
    const auto growth = [&](const mesh::Scene& s) {
      return double(split(s.mesh, text).set.references.size()) / double(s.mesh.triangles.size());
    };
    EXPECT_LT(growth(scene("organic", 20'000)), 1.01);
    EXPECT_LT(growth(scene("atrium", 20'000)), 1.01);
    EXPECT_GT(growth(scene("atrium", 20'000, {30, 40, 20})), 1.02);
  }
}

TEST(EdgeVolume, AutoKeepsTheBudgetAndUsesIt) {
  const mesh::Scene ship = scene("spaceship", 20'000);
  const auto triangles = static_cast<double>(ship.mesh.triangles.size());
  std::size_t fewest = ship.mesh.triangles.size();
  for (const char* budget : {"1", "1.1", "1.5", "4"}) {
    const Split result = split(ship.mesh, std::string("evh:auto,t.most=30,budget=") + budget);
    const double growth = double(result.set.references.size()) / triangles;
    EXPECT_LE(growth, std::atof(budget));
    EXPECT_GE(growth, 0.9 * std::atof(budget));
    EXPECT_GE(result.set.references.size(), fewest);
    fewest = result.set.references.size();
    // The t it says it took gives the same references.
    EXPECT_EQ(split(ship.mesh, "evh:t=" + std::to_string(result.report.t)).set.references.size(), fewest);
  }
  EXPECT_LE(split(ship.mesh, "evh:auto,budget=64,t.most=5").report.t, 5);
}

TEST(Presplit, IsTheSameForEveryNumberOfThreads) {
  TriangleMesh mesh = turned(test::soup(20'000, 9), {10, 20, 30});
  mesh.vertices[17].y = std::nanf("");
  for (const char* text : {"evh:t=12", "evh:auto,budget=1.4", "evh:clip", "esc:k=500"}) {
    const Split one = split(mesh, text);
    EXPECT_EQ(one.set.excluded, 1u);
    for (const int threads : {2, 8}) {
      ThreadExecutor executor(threads);
      const Split many = split(mesh, text, executor);
      ASSERT_EQ(many.set.references.size(), one.set.references.size());
      EXPECT_EQ(0, std::memcmp(many.set.references.data(), one.set.references.data(), one.set.references.bytes()));
      EXPECT_EQ(many.report.area_after, one.report.area_after);
      EXPECT_EQ(many.report.average_factor, one.report.average_factor);
    }
  }
}

}  // namespace
}  // namespace boxwood::refs
