// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "soslam/image/frame_choice.h"
#include "soslam/image/image_format.h"

namespace soslam {

// True if a file of this name is an image of a format that is read.
bool HasNameOfImage(const std::filesystem::path& path);

inline constexpr const char* kRawRemedy =
    "give the JPEGs that the camera wrote with them, or ones developed from them";

struct Photo {
  std::filesystem::path path;
  ImageHeader header;         // with a size of zero if it cannot be read
  bool is_raw = false;        // which cannot be read
  std::string original = {};  // name of the photo of which it is a duplicate; empty if of none
};

// Compares like the name, with numbers as numbers (IMG_9 before IMG_10): they are all made equally
// long. Of two equal ones the name counts: a7 after a007, in any folder.
std::pair<std::string, std::string> OrderOfName(const std::filesystem::path& path);

// The photos directly in a folder, in the order of their names. Of files with the same bytes the
// original is the one whose name is like most others but for numbers ("IMG_1.jpg", not
// "IMG_1 (1).jpg"), of several the first. Hidden files and files that have no name of an image are
// ignored; those of other image formats are listed, without a header. Throws InputError for a
// folder that cannot be read, has less than two photos, more than can be processed, or a name that
// is not UTF-8.
std::vector<Photo> ListPhotos(const std::filesystem::path& folder);

// Upright size and focal length (over the diagonal) that most of the photos have; of sizes that
// equally many have the largest. Duplicates do not count.
struct CommonCamera {
  ImageSize size;
  std::optional<double> focal_over_diagonal;  // none if no photo states one
};

// Throws InputError, naming the folder, if no photo has a header.
CommonCamera FindCommonCamera(const std::filesystem::path& folder,
                              const std::vector<Photo>& photos);

// The reason why a photo is none of this camera, and its size or focal length in words; none if it
// is, or if its header cannot be read. A photo that states no focal length may have any.
struct OtherCamera {
  FrameRejection reason;
  std::string detail;
};
std::optional<OtherCamera> FindOtherCamera(const Photo& photo, const CommonCamera& common);

struct PhotoOrder {
  bool is_by_time = false;
  int usable = 0;      // photos of the common camera, without duplicates
  int steps_back = 0;  // steps to an earlier time among these in the order of names
};

// Puts photos, which are in the order of names, into the order of their EXIF times where names have
// none: where all usable photos have times that contradict the names, and the names are not told
// apart by numbers first, as those of hashes. Names that are (01_door, 02_window) keep their order,
// and so do those that differ in numbers only, except where their counter began anew: at the only
// step back in time, where its numbers, all of one length, have their widest gap. A clock that was
// set leaves no such gap.
PhotoOrder OrderByTime(const CommonCamera& common, std::vector<Photo>* photos);

}  // namespace soslam
