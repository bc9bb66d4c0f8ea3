// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/photo_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>
#include <string_view>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/dataset/dataset_files.h"
#include "soslam/dataset/text_file.h"
#include "soslam/geometry/image_size.h"
#include "soslam/system/run_log.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxPhotos = 5000;
constexpr double kMaxFocalChange = 0.05;

// Into a folder of their own, so that each photo is there once.
constexpr const char* kConversion =
    "mkdir jpg; for f in *.HEIC; do heif-convert -q 95 \"$f\" \"jpg/$f.jpg\"; done (Debian's "
    "package libheif-examples), and give the folder jpg";

bool HasNameOfHeif(const fs::path& path) {
  const std::string extension = LowerCase(path.extension().string());
  return extension == ".heic" || extension == ".heif" || extension == ".avif";
}

constexpr std::string_view kDigits = "0123456789";

bool HasHeader(const Photo& photo) { return photo.header.stored.width > 0; }

bool IsDuplicate(const Photo& photo) { return !photo.original.empty(); }

// The name without its extension, each number as a 0.
std::string PatternOfName(const Photo& photo) {
  static const std::regex kNumber("[0-9]+");
  return std::regex_replace(photo.path.stem().string(), kNumber, "0");
}

void FindDuplicates(std::vector<Photo>* photos) {
  std::map<std::uintmax_t, std::vector<Photo*>> by_length;
  for (Photo& photo : *photos) {
    std::error_code ignored;
    if (HasHeader(photo)) by_length[fs::file_size(photo.path, ignored)].push_back(&photo);
  }
  std::map<std::string, std::vector<Photo*>> by_content;
  for (const auto& [length, of_length] : by_length) {
    if (of_length.size() == 1) continue;
    for (Photo* photo : of_length) by_content[DigestOfInput(photo->path)].push_back(photo);
  }
  std::map<std::string, int> counts;
  for (const Photo& photo : *photos) ++counts[PatternOfName(photo)];
  for (const auto& [digest, same] : by_content) {
    const Photo* original = *std::ranges::min_element(same, {}, [&](const Photo* photo) {
      return std::pair(-counts.at(PatternOfName(*photo)), photo->path.native().size());
    });
    for (Photo* photo : same) {
      if (photo != original) photo->original = original->path.filename().string();
    }
  }
}

// The last number in the name; 0 if there is none.
double NumberInName(const Photo& photo) {
  const std::string stem = photo.path.stem().string();
  const size_t last = stem.find_last_of(kDigits);
  if (last == stem.npos) return 0.0;
  return std::stod(stem.substr(stem.find_last_not_of(kDigits, last) + 1));
}

bool IsStepBack(const Photo* one, const Photo* next) {
  return next->header.time_taken < one->header.time_taken;
}

// True if the numbers of these names, all of one length, have their widest gap at a step back in
// time.
bool CounterBeganAnew(const std::vector<const Photo*>& photos) {
  double widest_back = 0.0, widest_on = 1.0;
  for (size_t i = 1; i < photos.size(); ++i) {
    const Photo &one = *photos[i - 1], &next = *photos[i];
    if (one.path.stem().string().size() != next.path.stem().string().size()) return false;
    double& widest = IsStepBack(&one, &next) ? widest_back : widest_on;
    widest = std::max(widest, NumberInName(next) - NumberInName(one));
  }
  return widest_back > widest_on;
}

// True if each name first differs from the next in a counter before a word: 01_door, 02_window. A
// counter has at most four digits; hashes and dates are none.
bool AreNumbered(const std::vector<const Photo*>& photos) {
  for (size_t i = 1; i < photos.size(); ++i) {
    const std::string one = photos[i - 1]->path.stem().string();
    const std::string next = photos[i]->path.stem().string();
    const auto same = std::ranges::mismatch(one, next).in1 - one.begin();
    const size_t begin = one.substr(0, same).find_last_not_of(kDigits) + 1;
    const auto number = [&](const std::string& name) {
      constexpr size_t kMostDigits = 4;
      constexpr std::string_view kSeparators = " _-.,()";
      const size_t end = std::min(name.find_first_not_of(kDigits, begin), name.size());
      const size_t word = std::min(name.find_first_not_of(kSeparators, end), name.size());
      const bool is_counter =
          end - begin <= kMostDigits &&
          (word == name.size() || (word > end && kDigits.find(name[word]) == kDigits.npos));
      return is_counter ? name.substr(begin, end - begin) : "";
    };
    if (number(one).empty() || number(next).empty() || number(one) == number(next)) return false;
  }
  return true;
}

bool IsSameFocalLength(double one, double other) {
  return std::abs(one - other) <= kMaxFocalChange * other;
}

}  // namespace

std::pair<std::string, std::string> OrderOfName(const fs::path& path) {
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

bool HasNameOfImage(const fs::path& path) {
  static const std::set<std::string> kExtensions = {".jpg",  ".jpeg", ".jpe", ".png",
                                                    ".webp", ".bmp",  ".tif", ".tiff"};
  return kExtensions.contains(LowerCase(path.extension().string()));
}

std::vector<Photo> ListPhotos(const fs::path& folder) {
  if (!IsFolder(folder)) {
    throw InputError(folder.string() + ": no such folder; expected a folder of photos");
  }
  std::vector<fs::path> images;
  std::vector<std::string> others;
  for (const fs::path& path : FolderEntries(folder)) {
    const std::string name = path.filename().string();
    if (name.starts_with('.')) continue;
    const std::string extension = LowerCase(path.extension().string());
    const bool is_image_not_read = HasNameOfHeif(path) || HasNameOfRawPhoto(path) ||
                                   extension == ".gif" || extension == ".jxl";
    if (!(HasNameOfImage(path) || is_image_not_read) || !IsFile(path)) {
      others.push_back(name);
    } else if (!IsUtf8(name)) {
      throw InputError(fmt::format("{}: image '{}' has a name that is not UTF-8; rename it",
                                   folder.string(), name));
    } else {
      images.push_back(path);
    }
  }
  std::ranges::sort(images, {}, &OrderOfName);
  if (images.size() < 2) {
    throw InputError(fmt::format(
        "{}: has {} image(s); expected at least 2 (JPEG, PNG, WebP, BMP or TIFF) of one scene, "
        "directly in this folder; a video is given itself{}{}",
        folder.string(), images.size(), others.empty() ? "" : ". It also has ",
        NamesInWords(others, 5)));
  }
  if (images.size() > kMaxPhotos) {
    throw InputError(fmt::format("{}: has {} images; expected at most {}: give a part of them",
                                 folder.string(), images.size(), kMaxPhotos));
  }
  std::vector<Photo> photos;
  for (const fs::path& path : images) {
    photos.push_back({path, ReadImageHeader(path).value_or(ImageHeader()), IsRawPhoto(path)});
  }
  FindDuplicates(&photos);
  return photos;
}

CommonCamera FindCommonCamera(const fs::path& folder, const std::vector<Photo>& photos) {
  std::map<ImageSize, int> counts;
  for (const Photo& photo : photos) {
    if (!HasHeader(photo) || IsDuplicate(photo)) continue;
    ++counts[photo.header.Size(ImageOrientation::kUpright)];
  }
  if (counts.empty()) {
    const auto raw = std::ranges::count_if(photos, &Photo::is_raw);
    const bool are_heif =
        std::ranges::any_of(photos, [](const Photo& photo) { return HasNameOfHeif(photo.path); });
    throw InputError(fmt::format(
        "{}: none of its {} images can be read, as {}; expected JPEG, PNG, WebP, BMP or TIFF{}{}{}",
        folder.string(), photos.size(), photos.front().path.filename().string(),
        raw > 0 ? fmt::format(": {} are RAW photos; {}", raw, kRawRemedy) : "",
        are_heif ? ": convert HEIC with " : "", are_heif ? kConversion : ""));
  }
  const auto most = std::ranges::max_element(counts, {}, [](const auto& entry) {
    const auto& [size, count] = entry;
    return std::pair(count, static_cast<double>(size.width) * static_cast<double>(size.height));
  });
  CommonCamera common{most->first, std::nullopt};
  std::vector<double> focal_lengths;
  for (const Photo& photo : photos) {
    const auto& focal = photo.header.focal_over_diagonal;
    if (focal && !IsDuplicate(photo) && !FindOtherCamera(photo, common)) {
      focal_lengths.push_back(*focal);
    }
  }
  if (focal_lengths.empty()) return common;
  std::ranges::sort(focal_lengths);
  // The one that most others are close to; of several the smallest.
  common.focal_over_diagonal = *std::ranges::max_element(focal_lengths, {}, [&](double focal) {
    return std::ranges::count_if(focal_lengths,
                                 [&](double other) { return IsSameFocalLength(other, focal); });
  });
  return common;
}

std::optional<OtherCamera> FindOtherCamera(const Photo& photo, const CommonCamera& common) {
  if (!HasHeader(photo)) return std::nullopt;
  const ImageSize size = photo.header.Size(ImageOrientation::kUpright);
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

PhotoOrder OrderByTime(const CommonCamera& common, std::vector<Photo>* photos) {
  std::vector<const Photo*> usable;
  for (const Photo& photo : *photos) {
    if (HasHeader(photo) && !IsDuplicate(photo) && !FindOtherCamera(photo, common)) {
      usable.push_back(&photo);
    }
  }
  PhotoOrder order{false, static_cast<int>(usable.size()), 0};
  const auto has_time = [](const Photo* photo) { return !photo->header.time_taken.empty(); };
  if (usable.empty() || !std::ranges::all_of(usable, has_time)) return order;
  bool are_counted = true;
  for (size_t i = 1; i < usable.size(); ++i) {
    order.steps_back += IsStepBack(usable[i - 1], usable[i]) ? 1 : 0;
    are_counted = are_counted && PatternOfName(*usable[i]) == PatternOfName(*usable.front());
  }
  order.is_by_time = are_counted ? order.steps_back == 1 && CounterBeganAnew(usable)
                                 : order.steps_back > 0 && !AreNumbered(usable);
  if (!order.is_by_time) return order;
  std::ranges::stable_sort(*photos, {}, [](const Photo& photo) {
    const std::string& time = photo.header.time_taken;
    return std::pair(time.empty(), time);
  });
  return order;
}

}  // namespace soslam
