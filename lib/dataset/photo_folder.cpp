// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/photo_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/paths.h"
#include "base/text.h"
#include "dataset/dataset_files.h"
#include "dataset/text_file.h"
#include "geometry/image_size.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxPhotos = 5000;
constexpr double kMaxFocalChange = 0.05;

// Into a folder of their own, so that each photo is there once.
constexpr const char* kConversion =
    "mkdir jpg; for f in *.HEIC; do heif-convert -q 95 \"$f\" \"jpg/$f.jpg\"; done (Debian's "
    "package libheif-examples), and give the folder jpg";

// Image formats that are not read.
bool HasNameOfOtherImage(const fs::path& path) {
  static const std::set<std::string> kExtensions = {".heic", ".heif", ".avif", ".dng", ".cr2",
                                                    ".cr3",  ".nef",  ".arw",  ".gif", ".jxl"};
  return kExtensions.contains(LowerCase(path.extension().string()));
}

// Compares like the name, with numbers as numbers: they are all made equally long. Of two equal
// ones the name counts: a7 after a007, in any folder.
std::pair<std::string, std::string> OrderOf(const fs::path& path) {
  constexpr const char* kDigits = "0123456789";
  constexpr size_t kMaxName = 255;  // bytes of a file's name
  const std::string name = path.filename().string();
  std::string order;
  for (size_t begin = 0; begin < name.size();) {
    const size_t number = std::min(name.find_first_of(kDigits, begin), name.size());
    const size_t end = std::min(name.find_first_not_of(kDigits, number), name.size());
    order.append(name, begin, number - begin);
    if (number < end) order.append(kMaxName - (end - number), '0');
    order.append(name, number, end - number);
    begin = end;
  }
  return {order, name};
}

struct FilesOfFolder {
  std::vector<fs::path> images;
  std::vector<std::string> others;
};

FilesOfFolder PhotosAndOthersIn(const fs::path& folder) {
  FilesOfFolder files;
  for (const fs::path& path : FolderEntries(folder)) {
    const std::string name = path.filename().string();
    if (name.starts_with('.')) continue;
    if (!(HasNameOfImage(path) || HasNameOfOtherImage(path)) || !IsFile(path)) {
      files.others.push_back(name);
    } else if (!IsUtf8(name)) {
      throw InputError(fmt::format("{}: image '{}' has a name that is not UTF-8; rename it",
                                   folder.string(), name));
    } else {
      files.images.push_back(path);
    }
  }
  std::ranges::sort(files.images, {}, &OrderOf);
  return files;
}

bool HasHeader(const Photo& photo) { return photo.header.stored.width > 0; }

bool IsSameFocalLength(double one, double other) {
  return std::abs(one - other) <= kMaxFocalChange * other;
}

// The focal length that most others are close to; of several the smallest.
std::optional<double> CommonFocalLength(std::vector<double> focal_lengths) {
  if (focal_lengths.empty()) return std::nullopt;
  std::ranges::sort(focal_lengths);
  return *std::ranges::max_element(focal_lengths, {}, [&](double focal) {
    return std::ranges::count_if(focal_lengths,
                                 [&](double other) { return IsSameFocalLength(other, focal); });
  });
}

}  // namespace

bool HasNameOfImage(const fs::path& path) {
  static const std::set<std::string> kExtensions = {".jpg",  ".jpeg", ".jpe", ".png",
                                                    ".webp", ".bmp",  ".tif", ".tiff"};
  return kExtensions.contains(LowerCase(path.extension().string()));
}

std::vector<Photo> ListPhotos(const fs::path& folder) {
  if (!IsFolder(folder)) {
    throw InputError(folder.string() + ": no such folder; expected a folder of photos");
  }
  const FilesOfFolder files = PhotosAndOthersIn(folder);
  if (files.images.size() < 2) {
    throw InputError(fmt::format(
        "{}: has {} image(s); expected at least 2 (JPEG, PNG, WebP, BMP or TIFF) of one scene, "
        "directly in this folder; a video is given itself{}{}",
        folder.string(), files.images.size(), files.others.empty() ? "" : ". It also has ",
        NamesInWords(files.others, 5)));
  }
  if (files.images.size() > kMaxPhotos) {
    throw InputError(fmt::format("{}: has {} images; expected at most {}: give a part of them",
                                 folder.string(), files.images.size(), kMaxPhotos));
  }
  std::vector<Photo> photos;
  for (const fs::path& path : files.images) {
    photos.push_back({path, ReadImageHeader(path).value_or(ImageHeader())});
  }
  return photos;
}

CommonCamera FindCommonCamera(const fs::path& folder, const std::vector<Photo>& photos,
                              ImageOrientation read_as) {
  std::map<ImageSize, int> counts;
  for (const Photo& photo : photos) {
    if (HasHeader(photo)) ++counts[photo.header.Size(read_as)];
  }
  if (counts.empty()) {
    const bool are_heif = std::ranges::any_of(
        photos, [](const Photo& photo) { return HasNameOfOtherImage(photo.path); });
    throw InputError(fmt::format(
        "{}: none of its {} images can be read, as {}; expected JPEG, PNG, WebP, BMP or TIFF{}{}",
        folder.string(), photos.size(), photos.front().path.filename().string(),
        are_heif ? ": convert HEIC with " : "", are_heif ? kConversion : ""));
  }
  const auto most =
      std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
  CommonCamera common{read_as, most->first, std::nullopt};
  std::vector<double> focal_lengths;
  for (const Photo& photo : photos) {
    const auto& focal = photo.header.focal_over_diagonal;
    if (focal && !FindOtherCamera(photo, common)) focal_lengths.push_back(*focal);
  }
  common.focal_over_diagonal = CommonFocalLength(std::move(focal_lengths));
  return common;
}

std::optional<OtherCamera> FindOtherCamera(const Photo& photo, const CommonCamera& common) {
  if (!HasHeader(photo)) return std::nullopt;
  const ImageSize size = photo.header.Size(common.read_as);
  if (size != common.size) {
    return OtherCamera{FrameRejection::kOtherSize,
                       fmt::format("{} x {} px, not {} x {}", size.width, size.height,
                                   common.size.width, common.size.height)};
  }
  const auto& focal = photo.header.focal_over_diagonal;
  if (!focal || !common.focal_over_diagonal ||
      IsSameFocalLength(*focal, *common.focal_over_diagonal)) {
    return std::nullopt;
  }
  const double diagonal = std::hypot(size.width, size.height);
  return OtherCamera{FrameRejection::kOtherFocalLength,
                     fmt::format("{:.0f} px, not {:.0f}", *focal * diagonal,
                                 *common.focal_over_diagonal * diagonal)};
}

}  // namespace soslam
