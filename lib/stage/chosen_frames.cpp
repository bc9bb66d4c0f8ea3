// SPDX-License-Identifier: BSD-3-Clause
#include "stage/chosen_frames.h"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "dataset/chosen_boxes.h"
#include "dataset/labelled_box.h"

namespace soslam {
namespace {

// The likely cause and the remedy where much is left out for one reason.
struct Advice {
  FrameRejection reason;
  const char* cause;
  const char* remedy;
};
constexpr std::array kAdvice = {
    Advice{FrameRejection::kUnreadable, "files of another format, or copied incompletely",
           "convert them to JPEG, or copy them again"},
    Advice{FrameRejection::kOtherSize, "photos of several cameras, or upright ones among others",
           "take all photos with one camera that is held in one way"},
    Advice{FrameRejection::kOtherFocalLength, "a zoom, or several lenses of one telephone",
           "take all photos with one lens, without zoom"},
    Advice{FrameRejection::kBlurred, "a camera that moved while the image was taken",
           "move more slowly, with more light; or lower min_sharpness"}};

}  // namespace

std::map<std::string, int> CountLeftOut(const std::vector<SourceFrame>& frames) {
  std::map<std::string, int> counts;
  for (const SourceFrame& frame : frames) {
    if (frame.rejection) ++counts[kFrameRejectionNames[static_cast<size_t>(*frame.rejection)]];
  }
  return counts;
}

std::vector<Finding> CheckFrames(const ChosenFrames& chosen) {
  constexpr int kFewest = 6;
  const FramesRecord& record = chosen.record;
  std::vector<Finding> findings;
  const int all = static_cast<int>(record.frames.size());
  const auto counts = CountLeftOut(record.frames);
  for (const Advice& advice : kAdvice) {
    const std::string name = kFrameRejectionNames[static_cast<size_t>(advice.reason)];
    const auto found = counts.find(name);
    if (found == counts.end() || all < kFewest || 3 * found->second <= all) continue;
    findings.push_back({"frames_" + name, Severity::kWarning,
                        fmt::format("{} of {} images are left out as {}", found->second, all, name),
                        "at most a third left out for one reason", advice.cause, advice.remedy});
  }
  if (chosen.is_cut_short) {
    findings.push_back(
        {"video_cut_short", Severity::kWarning,
         fmt::format("{}: {} frames can be decoded, fewer than it announces", record.name, all),
         "all frames", "a file that was copied or recorded incompletely", "copy it again"});
  }
  return findings;
}

std::string FrameListText(const std::vector<SourceFrame>& frames) {
  std::string text = "# timestamp filename\n";
  int count = 0;
  for (const SourceFrame& frame : frames) {
    if (IsLeftOut(frame)) continue;
    text += fmt::format("{} {}\n", frame.time_s.value_or(count), frame.image);
    ++count;
  }
  return text;
}

std::string FrameBoxesText(const std::filesystem::path& path, const ChosenFrames& chosen) {
  std::vector<std::optional<int>> rows;
  int row = 0;
  for (const SourceFrame& frame : chosen.record.frames) {
    rows.push_back(IsLeftOut(frame) ? std::nullopt : std::optional(row++));
  }
  const std::vector<LabelledBox> boxes = ReadDetectionsCsv(path);
  const ChosenBoxes of_chosen = BoxesOfChosen(
      boxes, rows, static_cast<double>(chosen.record.width) / chosen.source_size.width,
      static_cast<double>(chosen.record.height) / chosen.source_size.height);
  if (of_chosen.boxes.empty()) {
    throw InputError(fmt::format(
        "{}: none of its {} boxes is of a chosen image; expected as `frame` the number of the "
        "image, from 0, in the order of their names or of the video",
        path.string(), boxes.size()));
  }
  fmt::print("{}: {} boxes of chosen images, {} of images that were left out, {} of others\n",
             path.filename().string(), of_chosen.boxes.size(), of_chosen.left_out,
             of_chosen.unknown);
  return fmt::format("{} from {}\n{}", kFrameBoxesMark, OneLine(path.filename().string()),
                     LabelledBoxesText(of_chosen.boxes));
}

}  // namespace soslam
