// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/dataset/image_path.h"
#include "soslam/evaluation/result_checks.h"
#include "soslam/ground/ground_checks.h"
#include "soslam/inspection/doubts.h"
#include "soslam/inspection/inspection.h"
#include "soslam/inspection/overlay.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"
#include "soslam/workflow/pipeline_stages.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

template <typename Value>
const Value& Required(const std::optional<Value>& value, const char* option,
                      const std::string& kind) {
  if (value) return *value;
  throw SettingsError(fmt::format("--image of kind '{}' needs {}", kind, option));
}

[[noreturn]] void RefuseFrame(int frame_id, const fs::path& file, int first, int last) {
  throw SettingsError(fmt::format("--frame {}: {} has no such frame; expected one of {} to {}",
                                  frame_id, file.string(), first, last));
}

// Undistorted grey image of a frame; uniform grey where there is no image, or no folder is given.
cv::Mat GreyImage(const InspectRequest& request, const Sequence& sequence, int frame_index) {
  const Frame& frame = sequence.frames[frame_index];
  if (!request.dataset || frame.image.empty()) {
    constexpr int kGrey = 72;
    const Camera& camera = sequence.CameraOf(frame);
    return {camera.height, camera.width, CV_8UC1, cv::Scalar(kGrey)};
  }
  const std::string place = fmt::format("{}: frame {}", sequence.name, frame.id);
  const fs::path path = ImagePath(*request.dataset, frame.image, place);
  return FrameImageReader(sequence).Read({&frame, path}, cv::IMREAD_GRAYSCALE);
}

cv::Mat DrawPicture(const InspectRequest& request) {
  const std::string kind = ReadArtefactHeader(request.file).at("kind");
  if (kind == "edges") {
    const int frame_id = Required(request.frame_id, "--frame", kind);
    const EdgesReader reader(request.file);
    if (!reader.Has(frame_id)) {
      const std::vector<int> ids = reader.FrameIds();
      if (ids.empty()) throw NothingUsableError(request.file.string() + ": has no frames");
      RefuseFrame(frame_id, request.file, ids.front(), ids.back());
    }
    return EdgesPicture(reader.Read(frame_id), request.layer, fmt::format("frame {}", frame_id));
  }
  if (kind != "sequence" && kind != "landmarks" && kind != "map" && kind != "symmetry") {
    throw SettingsError(
        fmt::format("{}: there is no picture of kind '{}'; expected sequence, landmarks, map, "
                    "edges or symmetry",
                    request.file.string(), kind));
  }
  const fs::path file =
      kind == "sequence" ? request.file : Required(request.sequence, "--sequence", kind);
  const int frame_id = Required(request.frame_id, "--frame", kind);
  const Sequence sequence = ReadSequence(file, PlaneNeed::kNotNeeded);
  const std::vector<Frame>& frames = sequence.frames;
  const auto frame = std::ranges::lower_bound(frames, frame_id, {}, &Frame::id);
  if (frames.empty()) throw NothingUsableError(file.string() + ": has no frames");
  if (frame == frames.end() || frame->id != frame_id) {
    RefuseFrame(frame_id, file, frames.front().id, frames.back().id);
  }
  const auto frame_index = static_cast<int>(frame - frames.begin());
  const std::string title = fmt::format("{}, frame {}", sequence.name, frame_id);
  if (kind == "symmetry") {
    const int object_id = Required(request.object_id, "--object", kind);
    const std::vector<SymmetryRecord> records = ReadSymmetry(request.file);
    const auto found = std::ranges::find_if(records, [&](const SymmetryRecord& record) {
      return record.frame_id == frame_id && record.object_id == object_id;
    });
    if (found == records.end()) {
      throw SettingsError(fmt::format("--object {}: {} has no observation of it in frame {}",
                                      object_id, request.file.string(), frame_id));
    }
    return SymmetryPicture(*found, GreyImage(request, sequence, frame_index),
                           fmt::format("{}, object {}", title, object_id));
  }
  const OverlayInput input =
      kind == "sequence" ? OverlayOfFrame(sequence, frame_index)
      : kind == "landmarks"
          ? OverlayOfLandmarks(sequence, ReadLandmarks(request.file, sequence), frame_index)
          : OverlayOfMap(sequence, ReadMap(request.file, sequence), frame_index);
  cv::Mat picture = DrawingGround(GreyImage(request, sequence, frame_index));
  DrawOverlay(input, &picture);
  std::vector<CaptionEntry> caption = OverlayLegend(input);
  caption.insert(caption.begin(), {title});
  return WithCaption(picture, caption);
}

std::string InBrackets(const std::string& doubts) {
  return doubts.empty() ? "" : fmt::format(" (uncertain: {})", doubts);
}

// One line on a map.json, such as "9 objects, scale +- 18 %, 2 objects uncertain": how many objects
// it has, and how well its scale is known by the world.json beside it, with the reason where
// something contradicts that; and one more where the map should not be trusted. Throws InputError.
std::string Headline(const InspectRequest& request) {
  const std::string kind = ReadArtefactHeader(request.file).at("kind");
  if (kind != "map") {
    throw SettingsError(fmt::format("{}: there is no headline of kind '{}'; expected a map",
                                    request.file.string(), kind));
  }
  const fs::path file = request.sequence.value_or(request.file.parent_path() / "sequence.json");
  CheckWasMadeOf(request.file, "map", file);
  const Sequence sequence = ReadSequence(file, PlaneNeed::kNotNeeded);
  const fs::path folder = request.file.parent_path();
  const MapEstimate estimate = ReadMap(request.file, sequence);
  const std::vector<std::string> doubts = DoubtsOfMap(folder, estimate, sequence);
  size_t placed = 0, uncertain = 0;
  for (size_t i = 0; i < estimate.objects.size(); ++i) {
    if (!estimate.objects[i].landmark_in_world) continue;
    ++placed;
    if (!doubts[i].empty()) ++uncertain;
  }
  std::optional<Artefact<WorldReport>> world;
  if (Exists(folder / "world.json")) world = ReadWorld(folder / "world.json");
  std::string line = Counted(placed, "object");
  if (world && world->body.scale) {
    line += fmt::format(", scale +- {:.0f} %{}", HalfIntervalPercent(*world->body.scale),
                        InBrackets(ContradictionsInWords(*world->body.scale)));
  } else if (world || !IsInMetresWithoutWorld(sequence)) {
    line += ", scale unknown";
  }
  const std::string doubt = world ? DoubtOfUp(world->findings) : "";
  if (!doubt.empty()) line += ", up" + InBrackets(doubt);
  if (uncertain > 0) line += fmt::format(", {} uncertain", Counted(uncertain, "object"));
  const std::string distrust = DistrustOfMap(world ? &world->body : nullptr, sequence);
  if (!distrust.empty()) line += "\ndo not trust this map: " + distrust;
  return line + "\n";
}

}  // namespace

std::string RunInspect(const InspectRequest& request, bool is_coloured) {
  if (request.headline) return Headline(request);
  if (request.sequence) {
    const std::string kind = ReadArtefactHeader(request.file).at("kind");
    if (kind == "landmarks" || kind == "map" || kind == "symmetry" || kind == "metrics") {
      CheckWasMadeOf(request.file, kind, *request.sequence);
    }
  }
  if (request.image) {
    if (request.image->extension() != ".png") {
      throw SettingsError(
          fmt::format("--image {}: expected a name that ends in .png", request.image->string()));
    }
    std::vector<uchar> bytes;
    cv::imencode(".png", DrawPicture(request), bytes);
    WriteTextFile(*request.image, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  if (request.image && !request.csv && !request.table) return "";
  std::optional<Sequence> sequence;
  if (request.sequence) sequence = ReadSequence(*request.sequence, PlaneNeed::kNotNeeded);
  const PipelineStage* stage = FindStage(
      ReadDocument<FileHeader>(ReadArtefactHeader(request.file), request.file.string()).stage);
  Inspection inspection =
      Inspect(request.file, sequence,
              stage == nullptr ? json::object() : stage->resolve(json::object(), stage->name));
  // With a picture the object is that of the picture.
  if (request.object_id && !request.image) KeepObject(*request.object_id, &inspection);
  if (!request.csv && !request.table) return FormatInspection(inspection, is_coloured);
  const ValueTable& table = FindTable(inspection, request.table);
  if (!request.csv) return FormatWholeTable(table, is_coloured);
  std::string csv = FormatCsv(table);
  if (*request.csv == "-") return csv;
  WriteTextFile(*request.csv, csv);
  return "";
}

}  // namespace soslam
