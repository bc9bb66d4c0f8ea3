// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/yaml_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/dataset/text_file.h"

namespace soslam {
namespace {

// Limits beyond any calibration: nesting depth, number of values, characters of all keys around a
// value, size.
constexpr size_t kMaxFieldDepth = 10;
constexpr size_t kMaxFieldValues = 100000;
constexpr size_t kMaxFieldPath = 200;
constexpr size_t kMaxFieldBytes = 1 << 20;

std::string JoinedLines(const std::string& text, const std::string& name, char separator) {
  if (text.size() > kMaxFieldBytes) {
    throw InputError(
        fmt::format("{}: has {} bytes; expected at most {}", name, text.size(), kMaxFieldBytes));
  }
  std::string joined;
  for (const TextLine& line : RawLines(text, name)) joined += line.text + separator;
  return joined;
}

class YamlReader {
 public:
  explicit YamlReader(const std::string& name) : name_(name) {}

  NamedFields Read(const std::string& text) {
    try {
      const YAML::Node root = YAML::Load(text);
      if (root.IsScalar() || root.IsSequence()) {
        Refuse(root.Mark(), "is no key: value; expected lines of key: value");
      }
      Add("", root, 0);
    } catch (const YAML::Exception& error) {
      Refuse(error.mark, error.msg + "; expected YAML: lines of key: value");
    }
    return std::move(fields_);
  }

 private:
  [[noreturn]] void Refuse(const YAML::Mark& mark, const std::string& what) const {
    if (mark.is_null()) throw InputError(fmt::format("{}: {}", name_, what));
    throw InputError(fmt::format("{}:{}: {}", name_, mark.line + 1, what));
  }

  void Add(const std::string& path, const YAML::Node& node, size_t depth) {
    if (depth > kMaxFieldDepth) Refuse(node.Mark(), "is nested too deep");
    if (++nodes_ > kMaxFieldValues) {
      Refuse(node.Mark(), fmt::format("has more than {} values", kMaxFieldValues));
    }
    if (node.IsScalar()) {
      // Aliases repeat values: what they come to is bounded as well.
      value_bytes_ += node.Scalar().size();
      if (value_bytes_ > kMaxFieldBytes) {
        Refuse(node.Mark(),
               fmt::format("has values of more than {} bytes, those of aliases included",
                           kMaxFieldBytes));
      }
      fields_[path].push_back(node.Scalar());
    }
    if (node.IsSequence()) {
      fields_[path];  // there, though it may be empty
      for (const YAML::Node& item : node) {
        if (item.IsNull()) {
          fields_[path].emplace_back();  // the items after it keep their places
        } else {
          Add(path, item, depth + 1);
        }
      }
    }
    if (!node.IsMap()) return;
    for (const auto& entry : node) {
      const std::string key = (path.empty() ? "" : path + ".") + entry.first.Scalar();
      if (key.size() > kMaxFieldPath) {
        Refuse(entry.first.Mark(),
               fmt::format("has a key of {} characters, with those around it; expected at most {}",
                           key.size(), kMaxFieldPath));
      }
      if (!keys_.insert(key).second) {
        Refuse(entry.first.Mark(), fmt::format("has key {} twice; expected once", key));
      }
      Add(key, entry.second, depth + 1);
    }
  }

  std::string name_;
  size_t nodes_ = 0;
  size_t value_bytes_ = 0;
  std::set<std::string> keys_;
  NamedFields fields_;
};

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
    tag.remove_prefix(is_end ? 2 : 1);
    const std::string name(tag.substr(0, tag.find_first_of(" \t\r\n/")));
    if (!is_end) {
      open_.push_back(name);
      if (open_.size() > kMaxFieldDepth) Refuse("is nested too deep");
      if (name.size() > kMaxFieldPath || Path().size() > kMaxFieldPath) {
        Refuse(fmt::format(
            "has an element whose name, with those around it, has more than {} characters",
            kMaxFieldPath));
      }
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
  NamedFields fields_;
};

}  // namespace

NamedFields YamlFields(const std::string& text, const std::string& name) {
  return YamlReader(name).Read(JoinedLines(text, name, '\n'));
}

NamedFields XmlFields(const std::string& text, const std::string& name) {
  return XmlReader(JoinedLines(text, name, ' '), name).Read();
}

}  // namespace soslam
