// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/xml_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

class XmlReader {
 public:
  XmlReader(std::string text, std::string place)
      : text_(std::move(text)), place_(std::move(place)), rest_(text_) {}

  NamedFields Read() {
    for (size_t tag = rest_.find('<'); tag != rest_.npos; tag = rest_.find('<')) {
      AddWords(rest_.substr(0, tag));
      rest_.remove_prefix(tag);
      if (rest_.starts_with("<!--")) {
        TakeUntil("-->");
      } else if (rest_.starts_with("<?") || rest_.starts_with("<!")) {
        TakeUntil(">");
      } else {
        ReadTag(TakeUntil(">"));
      }
    }
    if (!open_.empty()) Refuse(fmt::format("has <{}> that is not closed", open_.back()));
    if (fields_.empty()) Refuse("has no elements; expected a calibration as OpenCV writes it");
    return std::move(fields_);
  }

 private:
  [[noreturn]] void Refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", place_, what));
  }

  // Returns the text before `end` and consumes both.
  std::string_view TakeUntil(std::string_view end) {
    const size_t found = rest_.find(end);
    if (found == rest_.npos) Refuse(fmt::format("has a < without {}", end));
    const std::string_view taken = rest_.substr(0, found);
    rest_.remove_prefix(found + end.size());
    return taken;
  }

  // `tag`: "<name attributes", "<name/" or "</name".
  void ReadTag(std::string_view tag) {
    const bool is_empty = tag.ends_with('/');
    const bool is_end = tag.starts_with("</");
    const std::string name(
        tag.substr(is_end ? 2 : 1).substr(0, tag.substr(is_end ? 2 : 1).find_first_of(" \t\r\n/")));
    if (!is_end) {
      if (++elements_ > kMaxFieldValues)
        Refuse(fmt::format("has more than {} elements", kMaxFieldValues));
      open_.push_back(name);
      if (name.size() > kMaxFieldPath || Path().size() > kMaxFieldPath) {
        Refuse(
            fmt::format("has an element whose name, with those around it, has more than {} "
                        "characters",
                        kMaxFieldPath));
      }
      if (open_.size() > kMaxFieldDepth) Refuse("is nested too deep");
      if (open_.size() > 1 && !fields_.try_emplace(Path()).second) {
        Refuse(fmt::format("has <{}> twice; expected once", Path()));
      }
    }
    if (!is_end && !is_empty) return;
    if (open_.empty() || open_.back() != name) Refuse(fmt::format("has </{}> of nothing", name));
    open_.pop_back();
  }

  // Path of the innermost open element.
  std::string Path() const {
    return fmt::format("{}", fmt::join(std::span(open_).subspan(1), "."));
  }

  void AddWords(std::string_view text) {
    if (open_.size() < 2) return;
    std::vector<std::string>& values = fields_.at(Path());
    for (std::string_view word : SplitWords(text)) {
      if (++values_ > kMaxFieldValues)
        Refuse(fmt::format("has more than {} values", kMaxFieldValues));
      if (word.size() >= 2 && word.front() == '"' && word.back() == '"') {
        word = word.substr(1, word.size() - 2);
      }
      values.emplace_back(word);
    }
  }

  std::string text_;
  std::string place_;
  std::string_view rest_;
  std::vector<std::string> open_;
  size_t values_ = 0;
  size_t elements_ = 0;
  NamedFields fields_;
};

}  // namespace

NamedFields ReadXmlFields(const std::filesystem::path& path) {
  std::string text;
  for (const TextLine& line : ReadRawLines(path)) text += line.text + " ";
  return XmlReader(std::move(text), path.string()).Read();
}

}  // namespace soslam
