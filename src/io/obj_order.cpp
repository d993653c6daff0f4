#include "io/obj_order.h"

#include <unordered_set>

#include "io/sentence.h"

namespace boxwood::io {
namespace {

constexpr std::size_t kLongestLine = 1024;  // of an object's or group's name; longer ones are compared up to here

class LineReader {
 public:
  explicit LineReader(FileReader& file) : file_(file) {}

  // The beginning of the next line, if that is an `o` or `g` line; other lines are only passed over.
  bool next(std::string& line) {
    line.clear();
    ++number_;
    bool wanted = true;
    while (file_.prepare(1)) {
      const unsigned char* bytes = file_.data();
      const std::size_t size = file_.available();
      std::size_t i = 0;
      for (; i < size && bytes[i] != '\n' && bytes[i] != '\r'; ++i) {
        if (!wanted || (line.empty() && is_blank(bytes[i]))) continue;
        wanted = line.size() < kLongestLine && (!line.empty() || bytes[i] == 'o' || bytes[i] == 'g');
        if (wanted) line += static_cast<char>(bytes[i]);
      }
      const bool complete = i < size;
      file_.consume(complete ? i + 1 : i);
      if (complete) return true;
    }
    return false;
  }

  std::size_t number() const { return number_; }
  static bool is_blank(unsigned char c) { return c == ' ' || c == '\t'; }

 private:
  FileReader& file_;
  std::size_t number_ = 0;
};

// "o chair " -> "chair"
std::string name_in(const std::string& line) {
  std::size_t begin = 1, end = line.size();
  while (begin < end && LineReader::is_blank(line[begin])) ++begin;
  while (end > begin && LineReader::is_blank(line[end - 1])) --end;
  return line.substr(begin, end - begin);
}

}  // namespace

std::string obj_order_note(FileReader& file) {
  LineReader lines(file);
  std::string line, current;
  std::unordered_set<std::string> seen;
  while (lines.next(line)) {
    if (line.size() < 2 || !LineReader::is_blank(line[1])) continue;
    std::string name = name_in(line);
    // A group always begins a new object in assimp, an object line may return to an earlier one.
    const bool is_new = seen.insert(name).second;
    if (line[0] == 'o' && !is_new && name != current)
      return "the file comes back to its object '" + one_line(name) + "' in line " + std::to_string(lines.number()) +
             ", and assimp may move triangles of an object together: ids follow the objects";
    current = std::move(name);
  }
  return {};
}

}  // namespace boxwood::io
