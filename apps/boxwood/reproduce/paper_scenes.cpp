#include "reproduce/paper_scenes.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "text.h"

namespace boxwood::program::reproduce {
namespace {

// Stand-ins have the property that the paper's argument rests on; those of large scenes are smaller than the scenes.
constexpr PaperScene kScenes[] = {
    {"ebbvh", "Sponza", "sponza", 0, "scene:atrium,triangles=262000"},
    {"ebbvh", "Bunny", "bunny", 0, "scene:organic,triangles=69451"},
    {"ebbvh", "Dragon", "dragon", 0, "scene:organic,triangles=100000,seed=2"},
    {"ebbvh", "San-Miguel", "sanmiguel|san-miguel|san_miguel", 0, "scene:city,triangles=300000"},
    {"evh", "Space Ship", "ship", 1554416, "scene:spaceship,triangles=300000,rotate=45:45:0"},
    {"evh", "Kitchen", "kitchen", 110561, "scene:atrium,triangles=110561,seed=2,rotate=20:35:10"},
    {"evh", "Sponza (Frame 16)", "sponza", 66454, "scene:atrium,triangles=66454,rotate=45:10:15"},
    {"popov", "BUNNY", "bunny", 69451, "scene:organic,triangles=69451"},
    {"popov", "SPONZA", "sponza", 66454, "scene:atrium,triangles=66454"},
    {"popov", "FAIRY", "fairy", 174117, "scene:foliage,triangles=174000"},
    {"popov", "CONFERENCE", "conference", 282759, "scene:atrium,triangles=282000,seed=2"},
    {"popov", "VENICE", "venice", 1236000, "scene:city,triangles=300000"},
    {"popov", "SODA HALL", "soda", 2169000, "scene:city,triangles=300000,seed=2"},
};

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

std::span<const PaperScene> paper_scenes() {
  return kScenes;
}

const PaperScene* match(const std::string& paper, const Input& input) {
  const std::string name = lower_case(input.mesh.name);
  const auto count = static_cast<double>(input.mesh.triangles.size());
  for (const PaperScene& scene : kScenes) {
    if (paper != scene.paper) continue;
    const auto words = split(scene.words, '|');
    const bool named = std::any_of(words.begin(), words.end(),
                                   [&](const std::string& word) { return name.find(word) != std::string::npos; });
    const auto expected = static_cast<double>(scene.triangles);
    if (named && (scene.triangles == 0 || std::fabs(count - expected) <= 0.1 * expected)) return &scene;
  }
  return nullptr;
}

Result<std::vector<Subject>> subjects(const std::string& paper, const std::vector<std::shared_ptr<const Input>>& inputs,
                                      const Session& session) {
  std::vector<Subject> list;
  for (const auto& input : inputs) {
    const PaperScene* const scene = match(paper, *input);
    list.push_back({input, input->mesh.name, scene ? scene->name : ""});
  }
  if (!inputs.empty()) return list;
  for (const PaperScene& scene : kScenes) {
    if (paper != scene.paper) continue;
    auto input = load_usable_input(scene.stand_in, {}, session);
    if (!input) return input.error();
    list.push_back(
        {std::make_shared<Input>(std::move(*input)), fmt::format("{} for {}", scene.stand_in, scene.name), scene.name});
  }
  return list;
}

}  // namespace boxwood::program::reproduce
