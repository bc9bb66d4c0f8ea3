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

// With symbolic links followed as far as there is something.
fs::path Resolved(const fs::path& path) {
  std::error_code error;
  fs::path resolved = fs::weakly_canonical(fs::absolute(path), error);
  return error ? path : resolved;
}

}  // namespace

fs::path ImagePath(const fs::path& dataset, const std::string& image, const std::string& place) {
  fs::path path = dataset / fs::path(image).lexically_normal();
  if (image.empty()) throw InputError(place + ": image is ''; expected the name of a file");
  const bool is_inside =
      !fs::path(image).is_absolute() && IsWithin(Resolved(path), Resolved(dataset));
  if (!is_inside && !OutsidePathsAreAllowed()) {
    throw InputError(
        fmt::format("{}: image is '{}', which is outside {}; expected a path inside the dataset "
                    "folder (--allow_outside_paths takes any)",
                    place, image, dataset.string()));
  }
  return path;
}

void AllowOutsidePaths(bool is_allowed) { OutsidePathsFlag() = is_allowed; }

bool OutsidePathsAreAllowed() { return OutsidePathsFlag(); }

}  // namespace soslam
