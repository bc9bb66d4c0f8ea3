// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/image_path.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/paths.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

bool& OutsidePathsFlag() {
  static bool are_allowed = false;
  return are_allowed;
}

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

void AllowOutsidePaths(bool is_allowed) { OutsidePathsFlag() = is_allowed; }

bool OutsidePathsAreAllowed() { return OutsidePathsFlag(); }

}  // namespace soslam
