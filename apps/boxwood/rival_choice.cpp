// What the words of --rivals mean.
#include <algorithm>

#include "bench_types.h"

namespace boxwood::program {
namespace {

constexpr std::string_view kPackets = ":packets";

Error no_such_rival(const std::string& word) {
  std::string list;
  for (const rivals::Library& library : rivals::libraries()) {
    list += (list.empty() ? "" : "; ") + std::string(library.id);
    for (const rivals::RivalInfo& rival : library.rivals)
      list += (&rival == library.rivals.data() ? " with " : ", ") + std::string(rival.id);
  }
  return {ErrorCode::unknown_name,
          fmt::format("there is no rival '{}'; there are {}; embree's also with :packets; and all", word, list)};
}

}  // namespace

Result<std::vector<RivalChoice>> find_rivals(const std::string& word) {
  std::vector<RivalChoice> choices;
  const bool wants_packets = word.ends_with(kPackets);
  const std::string id = wants_packets ? word.substr(0, word.size() - kPackets.size()) : word;
  for (const rivals::Library& library : rivals::libraries()) {
    if (word == "all" && !library.version()) continue;
    for (const rivals::RivalInfo& rival : library.rivals) {
      if (word != "all" && id != library.id && id != rival.id) continue;
      if (wants_packets && !rival.has_packets) continue;
      choices.push_back({&rival, wants_packets ? rivals::Calls::packets : rivals::Calls::single});
    }
  }
  if (choices.empty() && word != "all") return no_such_rival(word);
  return choices;
}

Result<std::string> rival_versions(const std::vector<RivalChoice>& choices) {
  std::string versions;
  for (const rivals::Library& library : rivals::libraries()) {
    const bool is_chosen = std::any_of(choices.begin(), choices.end(), [&](const RivalChoice& choice) {
      return choice.rival >= library.rivals.data() && choice.rival < library.rivals.data() + library.rivals.size();
    });
    if (!is_chosen) continue;
    const auto version = library.version();
    if (!version) return version.error();
    versions += (versions.empty() ? "" : ", ") + *version;
  }
  return versions;
}

}  // namespace boxwood::program
