// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "soslam/dataset/labelled_box.h"
#include "soslam/dataset/trajectories.h"

namespace soslam {

// Path of an image that a list names relative to its dataset folder, or by an absolute path into
// it. Throws InputError, naming `place`, for a name that is empty or leads out of the folder,
// directly or through a symbolic link: a dataset from elsewhere must not make the program read
// other files of the user.
std::filesystem::path ImagePath(const std::filesystem::path& dataset, const std::string& image,
                                const std::string& place);

// The name relative to its dataset folder, if it is an absolute path into it.
std::string NameInDataset(const std::filesystem::path& dataset, const std::string& image);

// Allows images outside their dataset folder, for the whole program; not thread-safe. Initially not
// allowed.
void AllowOutsidePaths(bool is_allowed);
bool OutsidePathsAreAllowed();

// Finds the row of an image list that a box belongs to.
class FrameLookup {
 public:
  explicit FrameLookup(const std::vector<ListedImage>& images);

  // The 0-based row; none when the list has no such image. A name is the path in the list, also
  // with backslashes, or the file name without folder, without extension or with that of another
  // image format; all of them also as Roboflow (a_jpg.rf.0123abcd.jpg) and Label Studio
  // (0123abcd-a.jpg) write the name of a copy. A folder may have another name than in the list, but
  // not that of another camera (cam0 and cam1, left and right). Throws InputError, naming `place`,
  // for a name shared by several images, for names with several folders of one image, and for
  // several names of one image.
  std::optional<int> Find(const FrameKey& key, const std::string& place);

  // Number of images found by the name of a copy, or with another extension.
  size_t CountOtherNames() const;

 private:
  std::vector<std::filesystem::path> folders_;  // folder of each row
  std::map<std::string, std::vector<int>> rows_by_name_;
  // Folder in the first name that was looked up, keyed by row.
  std::map<int, std::filesystem::path> named_folders_;
  // Name by which a row was found first, empty for its own name; keyed by row.
  std::map<int, std::string> other_names_;
};

// The row of the image of each pose, at least one; none for images that are not listed. Throws
// InputError for the second pose of an image, and when no image is listed.
std::vector<std::optional<int>> RowsOfPoses(const std::vector<NamedPose>& poses,
                                            const std::vector<ListedImage>& images);

}  // namespace soslam
