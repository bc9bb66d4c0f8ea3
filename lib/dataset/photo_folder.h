// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/frame_choice.h"
#include "image/image_format.h"

namespace soslam {

// True if a file of this name is an image of a format that is read.
bool HasNameOfImage(const std::filesystem::path& path);

struct Photo {
  std::filesystem::path path;
  ImageHeader header;  // with a size of zero if it cannot be read
};

// The photos directly in a folder, ordered by name with numbers as numbers (IMG_9 before IMG_10).
// Hidden files and files that have no name of an image are ignored; those of other image formats
// are listed, without a header. Throws InputError for a folder that cannot be read, has less than
// two photos, more than can be processed, or a name that is not UTF-8.
std::vector<Photo> ListPhotos(const std::filesystem::path& folder);

// Size and focal length (over the diagonal) that most of the photos have.
struct CommonCamera {
  ImageOrientation read_as;
  ImageSize size;
  std::optional<double> focal_over_diagonal;  // none if no photo states one
};

// Throws InputError, naming the folder, if no photo has a header.
CommonCamera FindCommonCamera(const std::filesystem::path& folder, const std::vector<Photo>& photos,
                              ImageOrientation read_as = ImageOrientation::kUpright);

// The reason why a photo is none of this camera, and its size or focal length in words; none if it
// is, or if its header cannot be read. A photo that states no focal length may have any.
struct OtherCamera {
  FrameRejection reason;
  std::string detail;
};
std::optional<OtherCamera> FindOtherCamera(const Photo& photo, const CommonCamera& common);

}  // namespace soslam
