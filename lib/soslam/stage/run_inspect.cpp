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

// Sequence and frame of a picture.
struct FrameOfSequence {
  Sequence sequence;
  int frame_index;
};

FrameOfSequence FrameFor(const InspectRequest& request, const std::string& kind) {
  const fs::path file =
      kind == "sequence" ? request.file : Required(request.sequence, "--sequence", kind);
  const int frame_id = Required(request.frame_id, "--frame", kind);
  Sequence sequence = ReadSequence(file, PlaneNeed::kNotNeeded);
  const auto found = std::ranges::lower_bound(sequence.frames, frame_id, {}, &Frame::id);
  if (sequence.frames.empty()) throw NothingUsableError(file.string() + ": has no frames");
  if (found == sequence.frames.end() || found->id != frame_id) {
    RefuseFrame(frame_id, file, sequence.frames.front().id, sequence.frames.back().id);
  }
  const auto frame_index = static_cast<int>(found - sequence.frames.begin());
  return {std::move(sequence), frame_index};
}

cv::Mat OverlayPicture(const InspectRequest& request, const std::string& kind) {
  const auto [sequence, frame_index] = FrameFor(request, kind);
  OverlayInput input;
  if (kind == "sequence") {
    input = OverlayOfFrame(sequence, frame_index);
  } else if (kind == "landmarks") {
    input = OverlayOfLandmarks(sequence, ReadLandmarks(request.file, sequence), frame_index);
  } else {
    input = OverlayOfMap(sequence, ReadMap(request.file, sequence), frame_index);
  }
  cv::Mat picture = DrawingGround(GreyImage(request, sequence, frame_index));
  DrawOverlay(input, &picture);
  std::vector<CaptionEntry> caption = OverlayLegend(input);
  caption.insert(caption.begin(), {fmt::format("{}, frame {}", sequence.name, *request.frame_id)});
  return WithCaption(picture, caption);
}

cv::Mat PictureOfEdges(const InspectRequest& request) {
  const int frame_id = Required(request.frame_id, "--frame", "edges");
  const EdgesReader reader(request.file);
  if (!reader.Has(frame_id)) {
    const std::vector<int> ids = reader.FrameIds();
    if (ids.empty()) throw NothingUsableError(request.file.string() + ": has no frames");
    RefuseFrame(frame_id, request.file, ids.front(), ids.back());
  }
  return EdgesPicture(reader.Read(frame_id), request.layer, fmt::format("frame {}", frame_id));
}

cv::Mat PictureOfSymmetry(const InspectRequest& request) {
  const auto [sequence, frame_index] = FrameFor(request, "symmetry");
  const int frame_id = *request.frame_id;
  const int object_id = Required(request.object_id, "--object", "symmetry");
  const std::vector<SymmetryRecord> records = ReadSymmetry(request.file);
  const auto found = std::ranges::find_if(records, [&](const SymmetryRecord& record) {
    return record.frame_id == frame_id && record.object_id == object_id;
  });
  if (found == records.end()) {
    throw SettingsError(fmt::format("--object {}: {} has no observation of it in frame {}",
                                    object_id, request.file.string(), frame_id));
  }
  return SymmetryPicture(
      *found, GreyImage(request, sequence, frame_index),
      fmt::format("{}, frame {}, object {}", sequence.name, frame_id, object_id));
}

cv::Mat PictureOf(const InspectRequest& request) {
  const std::string kind = ReadArtefactHeader(request.file).at("kind");
  if (kind == "edges") return PictureOfEdges(request);
  if (kind == "symmetry") return PictureOfSymmetry(request);
  if (kind == "sequence" || kind == "landmarks" || kind == "map") {
    return OverlayPicture(request, kind);
  }
  throw SettingsError(fmt::format(
      "{}: there is no picture of kind '{}'; expected sequence, landmarks, map, edges or symmetry",
      request.file.string(), kind));
}

void WritePng(const fs::path& path, const cv::Mat& picture) {
  if (path.extension() != ".png") {
    throw SettingsError(
        fmt::format("--image {}: expected a name that ends in .png", path.string()));
  }
  std::vector<uchar> bytes;
  cv::imencode(".png", picture, bytes);
  WriteTextFile(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string InBrackets(const std::string& doubts) {
  return doubts.empty() ? "" : fmt::format(" (uncertain: {})", doubts);
}

// ", scale ... (uncertain: ...), up (uncertain: ...)", up only if it is uncertain; empty for
// a world whose scale is given.
std::string WorldInHeadline(const std::optional<Artefact<WorldReport>>& world,
                            const Sequence& sequence) {
  constexpr const char* kUnknown = ", scale unknown";
  if (!world) return IsInMetresWithoutWorld(sequence) ? "" : kUnknown;
  std::string words = kUnknown;
  if (const auto& scale = world->body.scale) {
    words = fmt::format(", scale +- {:.0f} %{}", HalfIntervalPercent(*scale),
                        InBrackets(ContradictionsInWords(*scale)));
  }
  const std::string doubt = DoubtOfUp(world->findings);
  return doubt.empty() ? words : words + ", up" + InBrackets(doubt);
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
  std::string line = Counted(placed, "object") + WorldInHeadline(world, sequence);
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
  if (request.image) WritePng(*request.image, PictureOf(request));
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
  const ValueTable& table = TableOf(inspection, request.table);
  if (!request.csv) return FormatWholeTable(table, is_coloured);
  std::string csv = FormatCsv(table);
  if (*request.csv == "-") return csv;
  WriteTextFile(*request.csv, csv);
  return "";
}

}  // namespace soslam
