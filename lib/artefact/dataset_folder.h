// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artefact/json_file.h"
#include "image/frame_choice.h"

namespace soslam {

// A dataset folder that a program writes, and that appears completely or not at all: fill it with
// Write, then Commit(). SHA256SUMS in it lists its files, so that those that others have added or
// changed since are never replaced.
class DatasetFolder {
 public:
  // Creates the temporary folder beside `folder`. `writer` is the name of the program. Throws
  // SettingsError when `folder` is not a folder, contains anything but an earlier dataset of this
  // writer, unchanged, and records of runs, or cannot be written.
  DatasetFolder(const std::filesystem::path& folder, std::string writer);
  // Removes the temporary folder, or the one that it replaced.
  ~DatasetFolder();
  DatasetFolder(const DatasetFolder&) = delete;
  DatasetFolder& operator=(const DatasetFolder&) = delete;

  const std::filesystem::path& Temporary() const { return temporary_; }

  // Begin of the first line of README.md, by which a later run recognises a folder of its own.
  std::string Mark() const;

  // Writes a file of the folder. Throws SettingsError when the disk refuses.
  void Write(const std::string& name, std::string_view bytes) const;

  // Moves the temporary folder to the place of `folder`. Throws SettingsError when the disk
  // refuses, InputError as CheckInputsUnchanged.
  void Commit();

 private:
  void CheckReplaceable() const;
  void WriteSums() const;
  void Replace();

  std::filesystem::path folder_;
  std::string writer_;
  std::filesystem::path temporary_;
};

// A photo, or a frame of a video.
struct SourceFrame {
  std::string source;               // name of its file, without folders
  std::optional<int> frame_number;  // in a video, from 0
  std::optional<double> time_s;     // in a video, since its first frame
  std::optional<double> sharpness;  // none if it was not measured
  std::optional<FrameRejection> rejection;
  std::string detail = {};  // of the rejection, in words
  std::string image = {};   // path in the dataset folder; empty if it was left out
};

// A focal length that a reconstruction may start from: a guess, no calibration.
struct FocalHint {
  double focal_px;  // in the images of the dataset
  int images;       // number of chosen photos whose EXIF data have one
};

struct FramesRecord {
  std::string name;  // of the folder or video
  int width = 0;     // of the images of the dataset, px
  int height = 0;
  std::optional<FocalHint> focal_hint;
  std::string ordered_by = "time";  // of the video, or in the EXIF data of photos; or "name"
  std::vector<SourceFrame> frames;  // all, in this order
};

// The text of frames.json (kind "frames", schemas/frames.schema.json). Errors as ArtefactText.
std::string FramesText(const std::filesystem::path& path, const FramesRecord& record,
                       const ArtefactInfo& info);

}  // namespace soslam
