// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/yaml_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

// First position outside of quotes at which `found` is true; npos if there is none.
template <typename Found>
size_t FindUnquoted(std::string_view text, const Found& found) {
  char quote = '\0';
  for (size_t i = 0; i < text.size(); ++i) {
    if (quote == '\0' && found(i)) return i;
    const bool may_begin = i == 0 || std::string_view(" [{,:").find(text[i - 1]) != text.npos;
    if (quote == '\0' && may_begin && (text[i] == '"' || text[i] == '\'')) {
      quote = text[i];
    } else if (text[i] == quote) {
      quote = '\0';
    }
  }
  return text.npos;
}

std::string_view WithoutComment(std::string_view line) {
  return line.substr(0, FindUnquoted(line, [&](size_t i) {
                       return line[i] == '#' &&
                              (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t');
                     }));
}

// Position of the colon after a key.
size_t FindColon(std::string_view text) {
  return FindUnquoted(text, [&](size_t i) {
    return text[i] == ':' && (i + 1 == text.size() || text[i + 1] == ' ' || text[i + 1] == '\t');
  });
}

std::string_view Unquoted(std::string_view text) {
  const bool is_quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
                         text.front() == text.back();
  return is_quoted ? text.substr(1, text.size() - 2) : text;
}

// Number of open brackets at the end of a text.
int OpenBrackets(std::string_view text) {
  int open = 0;
  FindUnquoted(text, [&](size_t i) {
    if (text[i] == '[' || text[i] == '{') ++open;
    if (text[i] == ']' || text[i] == '}') --open;
    return false;
  });
  return open;
}

class YamlReader {
 public:
  explicit YamlReader(std::vector<TextLine> lines) : lines_(std::move(lines)) {}

  NamedFields Read() {
    for (; next_ < lines_.size(); ++next_) {
      const std::string_view line = WithoutComment(lines_[next_].text);
      const std::string_view text = Trimmed(line);
      if (text.starts_with("---") && !fields_.empty()) break;
      if (text.empty() || text.front() == '%' || text.starts_with("---") || text == "...") continue;
      const size_t indent = line.find_first_not_of(' ');
      if (line[indent] == '\t') Refuse("is indented by a tab; expected blanks");
      if (text == "-" || text.starts_with("- ")) {
        ReadItem(indent, Trimmed(text.substr(1)));
      } else {
        ReadKey(indent, text);
      }
    }
    return std::move(fields_);
  }

 private:
  // A key whose value is the more deeply indented lines below it.
  struct OpenKey {
    size_t indent;
    std::string path;
  };

  [[noreturn]] void Refuse(const std::string& what) const {
    throw InputError(lines_[std::min(next_, lines_.size() - 1)].place + ": " + what);
  }

  // Full path of a key; checks the limits.
  std::string Join(const std::string& path, std::string_view key) {
    if (++keys_ > kMaxFieldValues) Refuse(fmt::format("has more than {} keys", kMaxFieldValues));
    if (path.size() + key.size() > kMaxFieldPath) {
      Refuse(fmt::format("has a key of {} characters, with those around it; expected at most {}",
                         path.size() + key.size(), kMaxFieldPath));
    }
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
  }

  void ReadKey(size_t indent, std::string_view text) {
    while (!open_.empty() && open_.back().indent >= indent) open_.pop_back();
    const size_t colon = FindColon(text);
    if (colon == text.npos) Refuse(fmt::format("is '{}'; expected key: value", text));
    const std::string path =
        Join(open_.empty() ? "" : open_.back().path, Unquoted(Trimmed(text.substr(0, colon))));
    std::string_view value = Trimmed(text.substr(colon + 1));
    if (value.starts_with('!'))
      value = Trimmed(value.substr(std::min(value.find(' '), value.size())));
    if (fields_.contains(path)) Refuse(fmt::format("has key {} twice; expected once", path));
    if (value.empty()) {
      open_.push_back({indent, path});
      if (open_.size() > kMaxFieldDepth) Refuse("is nested too deep");
    } else if (value.front() == '|' || value.front() == '>') {
      SkipBlock(indent);
    } else {
      ReadFlow(path, value);
    }
  }

  void ReadItem(size_t indent, std::string_view text) {
    while (!open_.empty() && open_.back().indent > indent) open_.pop_back();
    if (open_.empty()) Refuse("has an item of no list; expected key: value");
    const bool is_flow = text.starts_with('[');
    if (!is_flow && FindColon(text) != text.npos) {
      Refuse("has a list of maps; expected lists of numbers or names");
    }
    ReadFlow(open_.back().path, text);
  }

  // Skips lines of text that belong to a key at this indentation.
  void SkipBlock(size_t indent) {
    while (next_ + 1 < lines_.size()) {
      const std::string& line = lines_[next_ + 1].text;
      const size_t begin = line.find_first_not_of(" \t");
      if (begin != line.npos && begin <= indent) return;
      ++next_;
    }
  }

  // Reads a scalar, or a value in brackets, possibly over several lines.
  void ReadFlow(const std::string& path, std::string_view begin) {
    std::string text(begin);
    if (text.starts_with('[') || text.starts_with('{')) {
      for (int open = OpenBrackets(text); open > 0;) {
        if (++next_ == lines_.size()) Refuse("has a bracket that is not closed");
        const std::string_view more = Trimmed(WithoutComment(lines_[next_].text));
        open += OpenBrackets(more);
        text += fmt::format(" {}", more);
      }
    }
    AddFlow(path, text, 0);
  }

  void AddFlow(const std::string& path, std::string_view text, size_t depth) {
    if (depth > kMaxFieldDepth) Refuse("is nested too deep");
    const bool is_list = text.starts_with('[') && text.ends_with(']');
    const bool is_map = text.starts_with('{') && text.ends_with('}');
    if (!is_list && !is_map) return AddValue(path, Unquoted(text));
    std::string_view rest = Trimmed(text.substr(1, text.size() - 2));
    if (is_list) fields_[path];
    while (!rest.empty()) {
      const std::string_view item = TakeItem(&rest);
      const size_t colon = is_map ? FindColon(item) : 0;
      if (colon == item.npos) Refuse(fmt::format("is '{}'; expected key: value", item));
      if (is_list) AddFlow(path, item, depth + 1);
      if (is_map) {
        AddFlow(Join(path, Unquoted(Trimmed(item.substr(0, colon)))),
                Trimmed(item.substr(colon + 1)), depth + 1);
      }
    }
  }

  // Returns the text before the next comma outside of brackets; `rest` becomes the text after it.
  static std::string_view TakeItem(std::string_view* rest) {
    int open = 0;
    const std::string_view text = *rest;
    const size_t end = FindUnquoted(text, [&](size_t i) {
      if (text[i] == '[' || text[i] == '{') ++open;
      if (text[i] == ']' || text[i] == '}') --open;
      return text[i] == ',' && open == 0;
    });
    *rest = end == text.npos ? std::string_view() : Trimmed(text.substr(end + 1));
    return Trimmed(text.substr(0, end));
  }

  void AddValue(const std::string& path, std::string_view value) {
    if (value.starts_with('&') || value.starts_with('*')) {
      Refuse(fmt::format("has the anchor '{}'; expected a value", value));
    }
    if (++values_ > kMaxFieldValues)
      Refuse(fmt::format("has more than {} values", kMaxFieldValues));
    fields_[path].emplace_back(value);
  }

  std::vector<TextLine> lines_;
  size_t next_ = 0;  // index of the current line
  size_t values_ = 0;
  size_t keys_ = 0;
  std::vector<OpenKey> open_;  // outermost first
  NamedFields fields_;
};

}  // namespace

NamedFields ReadYamlFields(const std::filesystem::path& path) {
  return YamlReader(ReadRawLines(path)).Read();
}

NamedFields YamlFields(const std::string& text, const std::string& name) {
  return YamlReader(RawLines(text, name)).Read();
}

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
