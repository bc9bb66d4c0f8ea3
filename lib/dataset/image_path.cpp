// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/image_path.h"

#include <fmt/format.h>

#include "base/error.h"

namespace soslam {

std::filesystem::path ImagePath(const std::filesystem::path& dataset, const std::string& image,
                                const std::string& place) {
  const std::filesystem::path relative = std::filesystem::path(image).lexically_normal();
  if (image.empty() || relative.is_absolute() || *relative.begin() == "..") {
    throw InputError(
        fmt::format("{}: image is '{}'; expected a path inside the dataset folder", place, image));
  }
  return dataset / relative;
}

}  // namespace soslam
