// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/yolo_texts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "base/error.h"
#include "base/file_kind.h"
#include "dataset/folder_entries.h"
#include "dataset/label_file.h"
#include "dataset/text_archive.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr std::array kLists = {"classes.txt", "train.txt", "val.txt", "valid.txt", "test.txt"};

// True for files that programs or systems add beside labels.
bool IsExtra(const fs::path& path) {
  const std::string name = path.filename().string();
  const auto is_of_macos = [](const fs::path& part) { return part == "__MACOSX"; };
  return name.starts_with('.') || name.starts_with("README") || name.starts_with("readme") ||
         std::any_of(path.begin(), path.end(), is_of_macos);
}

bool IsLabels(const fs::path& path) { return path.extension() == ".txt" && !IsExtra(path); }

// True if a file of this name is a list of something other than boxes.
bool IsList(const fs::path& path, const std::vector<TextLine>& lines) {
  if (std::ranges::find(kLists, path.filename().string()) == kLists.end()) return false;
  return !lines.empty() && !std::isdigit(static_cast<unsigned char>(lines.front().text.front()));
}

YoloTexts ReadFolder(const fs::path& folder) {
  YoloTexts texts;
  for (const fs::path& file : FolderEntries(folder)) {
    if (!IsLabels(file.filename())) continue;
    auto lines = ReadTextLines(file);
    if (!IsList(file, lines)) texts.images.push_back({file.stem().string(), std::move(lines)});
  }
  return texts;
}

YoloTexts ReadArchive(const fs::path& archive) {
  YoloTexts texts;
  const auto is_wanted = [](const fs::path& name) {
    return IsLabels(name) || (IsLabelFile(name) && !IsExtra(name));
  };
  for (const ArchivedText& entry : ReadTextArchive(archive, is_wanted)) {
    const std::string place = fmt::format("{}/{}", archive.string(), entry.name);
    if (IsLabels(entry.name)) {
      auto lines = TextLines(entry.text, place);
      if (!IsList(entry.name, lines)) {
        texts.images.push_back({fs::path(entry.name).stem().string(), std::move(lines)});
        continue;
      }
    }
    if (!IsLabelFile(entry.name) || texts.names) continue;
    texts.names = ParseLabels(entry.text, place);
    texts.names_place = place;
  }
  return texts;
}

}  // namespace

YoloTexts ReadYoloTexts(const fs::path& path) {
  if (!Exists(path)) {
    throw InputError(path.string() + ": is missing; expected a folder of YOLO text files");
  }
  YoloTexts texts = IsFolder(path) ? ReadFolder(path) : ReadArchive(path);
  if (texts.images.empty()) {
    throw InputError(path.string() + ": has no *.txt; expected one for each image");
  }
  std::set<std::string> images;
  for (const YoloText& text : texts.images) {
    if (images.insert(text.image).second) continue;
    throw InputError(fmt::format("{}: has several files {}.txt; expected one for each image",
                                 path.string(), text.image));
  }
  return texts;
}

}  // namespace soslam
