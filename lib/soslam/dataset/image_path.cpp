// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/image_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <set>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/dataset/photo_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

bool outside_paths_are_allowed = false;

// Path with symbolic links resolved as far as it exists.
fs::path Resolved(const fs::path& path) {
  std::error_code error;
  fs::path resolved = fs::weakly_canonical(fs::absolute(path), error);
  return error ? path : resolved;
}

}  // namespace

fs::path ImagePath(const fs::path& dataset, const std::string& image, const std::string& place) {
  fs::path path = dataset / fs::path(image).lexically_normal();
  if (image.empty()) throw InputError(place + ": image is ''; expected the name of a file");
  if (!IsWithin(Resolved(path), Resolved(dataset)) && !OutsidePathsAreAllowed()) {
    throw InputError(fmt::format(
        "{}: image is '{}', {} outside {}; expected a path inside the dataset "
        "folder (--allow_outside_paths takes any)",
        place, image, fs::path(image).is_absolute() ? "an absolute path that leads" : "which is",
        dataset.string()));
  }
  return path;
}

std::string NameInDataset(const fs::path& dataset, const std::string& image) {
  if (!fs::path(image).is_absolute()) return image;
  if (IsWithin(image, dataset)) {
    return PlainPath(image).lexically_relative(PlainPath(dataset)).string();
  }
  const fs::path resolved = Resolved(image);
  if (!IsWithin(resolved, Resolved(dataset))) return image;
  return resolved.lexically_relative(Resolved(dataset)).string();
}

void AllowOutsidePaths(bool is_allowed) { outside_paths_are_allowed = is_allowed; }

bool OutsidePathsAreAllowed() { return outside_paths_are_allowed; }

namespace {

fs::path FolderOf(const std::string& image) {
  return fs::path(image).lexically_normal().parent_path();
}

// Innermost components in which two folders differ, up to the length of the shorter; empty where
// they do not.
std::pair<std::string, std::string> Difference(fs::path one, fs::path other) {
  for (; one.has_filename() && other.has_filename();
       one = one.parent_path(), other = other.parent_path()) {
    if (one.filename() != other.filename()) {
      return {one.filename().string(), other.filename().string()};
    }
  }
  return {};
}

// Normalised folder name: lower case, numbers without leading zeros; image_02 and image_2 are one
// folder.
std::string PlainImageName(const std::string& name) {
  static const std::regex kLeadingZeros("(^|[^0-9])0+([0-9])");
  return std::regex_replace(LowerCase(name), kLeadingZeros, "$1$2");
}

constexpr size_t kMaxName = 255;  // bytes of a file's name; regular expressions are recursive

// Folder name without the part that distinguishes the cameras of a rig.
std::string ExtractRigName(const std::string& plain_name) {
  static const std::regex kCamera("(left|right|[0-9])+");
  return std::regex_replace(plain_name, kCamera, "0");
}

bool AreOfTwoCameras(const fs::path& folder, const fs::path& other) {
  const auto names = Difference(folder, other);
  if (std::max(names.first.size(), names.second.size()) > kMaxName) return false;
  const std::string name = PlainImageName(names.first), other_name = PlainImageName(names.second);
  return name != other_name && ExtractRigName(name) == ExtractRigName(other_name);
}

}  // namespace

FrameLookup::FrameLookup(const std::vector<ListedImage>& images) {
  for (const ListedImage& image : images) {
    const fs::path path = image.image;
    const std::set<std::string> names = {path.string(), path.filename().string(),
                                         (path.parent_path() / path.stem()).string(),
                                         path.stem().string()};
    const auto row = static_cast<int>(folders_.size());
    for (const std::string& name : names) rows_by_name_[name].push_back(row);
    folders_.push_back(FolderOf(image.image));
  }
}

namespace {

// Name of the image that an annotation tool copied to a file of this name, without extension in
// names of Roboflow; empty for other names.
std::string NameOfOriginal(const std::string& copy) {
  static const std::regex kRoboflow(R"((.+)_[a-z]+\.rf\.[0-9a-z]{8,}(\.[a-z]+)?)",
                                    std::regex::icase);
  // Not eight digits that are a date.
  static const std::regex kLabelStudio("(?!(?:19|20)[0-9]{6})[0-9a-f]{8}(?:-|__)(.+)");
  std::smatch parts;
  if (copy.size() > kMaxName) return "";
  const bool is_copy =
      std::regex_match(copy, parts, kRoboflow) || std::regex_match(copy, parts, kLabelStudio);
  return is_copy ? parts[1].str() : "";
}

}  // namespace

size_t FrameLookup::CountOtherNames() const {
  return static_cast<size_t>(std::ranges::count_if(
      other_names_, [](const auto& name_of_row) { return !name_of_row.second.empty(); }));
}

std::optional<int> FrameLookup::Find(const FrameKey& key, const std::string& place) {
  if (const int* row = std::get_if<int>(&key)) {
    return *row >= 0 && *row < std::ssize(folders_) ? std::optional(*row) : std::nullopt;
  }
  std::string name = std::get<std::string>(key);
  if (!rows_by_name_.contains(name)) std::ranges::replace(name, '\\', '/');  // Windows' paths
  const std::string file_name = fs::path(name).filename().string();
  const auto find = [&](const fs::path& image) {
    const auto found = rows_by_name_.find(image.string());
    const bool has_another_ending = found == rows_by_name_.end() && HasNameOfImage(image);
    return has_another_ending ? rows_by_name_.find((image.parent_path() / image.stem()).string())
                              : found;
  };
  const bool has_own_name = rows_by_name_.contains(name) || rows_by_name_.contains(file_name);
  auto found = rows_by_name_.find(has_own_name && !rows_by_name_.contains(name) ? file_name : name);
  if (found == rows_by_name_.end()) found = find(name);
  if (found == rows_by_name_.end()) found = find(file_name);
  if (found == rows_by_name_.end()) found = find(NameOfOriginal(file_name));
  if (found == rows_by_name_.end()) return std::nullopt;
  const std::vector<int>& rows = found->second;
  if (rows.size() > 1) {
    throw InputError(fmt::format("{}: image '{}' could be rows {} of the list; expected one", place,
                                 name, fmt::join(rows, ", ")));
  }
  const int row = rows.front();
  const fs::path folder = FolderOf(name);
  if (AreOfTwoCameras(folder, folders_[row])) return std::nullopt;
  const fs::path& named = named_folders_.try_emplace(row, folder).first->second;
  if (!Difference(folder, named).first.empty()) {
    throw InputError(
        fmt::format("{}: image '{}' would be row {} of the list, as that of the same name in '{}' "
                    "is; expected images of one folder",
                    place, name, row, named.string()));
  }
  const std::string other_name = has_own_name ? "" : file_name;
  if (other_names_.try_emplace(row, other_name).first->second != other_name) {
    throw InputError(
        fmt::format("{}: image '{}' would be row {} of the list, as another copy of it or itself "
                    "is; expected one name of each image, as exported without augmentation",
                    place, name, row));
  }
  return row;
}

std::vector<std::optional<int>> RowsOfPoses(const std::vector<NamedPose>& poses,
                                            const std::vector<ListedImage>& images) {
  FrameLookup lookup(images);
  std::vector<std::optional<int>> rows;
  std::set<int> found;
  for (const NamedPose& pose : poses) {
    rows.push_back(lookup.Find(pose.image, pose.place));
    if (rows.back() && !found.insert(*rows.back()).second) {
      throw InputError(fmt::format("{}: is the second pose of image '{}'; expected one", pose.place,
                                   pose.image));
    }
  }
  if (found.empty()) {
    std::vector<std::string> with_pose, listed;
    for (const NamedPose& pose : poses) with_pose.push_back(pose.image);
    for (const ListedImage& image : images) listed.push_back(image.image);
    throw InputError(fmt::format(
        "{}: none of the images with a pose ({}) is one of those that are listed ({}); expected "
        "the same names, apart from folders and endings: are the poses of other images, or were "
        "these renamed?",
        poses.front().place, NamesInWords(with_pose, 2), NamesInWords(listed, 2)));
  }
  return rows;
}

}  // namespace soslam
