// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/inspection/doubts.h"
#include "soslam/inspection/projection.h"
#include "soslam/model/segments.h"
#include "soslam/report/page_html.h"
#include "soslam/report/page_parts.h"
#include "soslam/report/plan_view.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr size_t kMaxPlaced = 100, kMaxNotPlaced = 40;
constexpr int kPicturePx = 160;  // at most, of width and height

// The largest box that is whole, or else the largest, among the frames with an image.
Picture ChoosePicture(const std::vector<SeenBox>& boxes, const ImageSource& images,
                      const Sequence& sequence) {
  const auto rank = [](const SeenBox& seen) { return std::pair(seen.is_whole, seen.box.Area()); };
  const SeenBox* best = nullptr;
  for (const SeenBox& seen : boxes) {
    if (!images.has(seen.frame_index)) continue;
    if (best == nullptr || rank(seen) > rank(*best)) best = &seen;
  }
  if (best == nullptr) return {};
  const Camera& camera = sequence.CameraOf(sequence.frames[best->frame_index]);
  return PictureOfBox(best->frame_index, best->box, camera);
}

// A thing in one of the section's lists.
struct Entry {
  std::string id;  // of its picture
  std::string name;
  std::vector<std::string> lines;
  Picture picture;
  std::string doubts = {};  // why it is uncertain; empty where it is not
};

std::string EntriesHtml(const std::vector<Entry>& entries, const Sequence& sequence) {
  std::string html = "<ul class=\"things\">\n";
  for (const Entry& entry : entries) {
    html += "<li>";
    if (!entry.picture.jpeg.empty()) {
      const int frame_id = sequence.frames[entry.picture.frame_index].id;
      html +=
          PictureSvg(entry.picture, fmt::format("{} in frame {}", entry.name, frame_id), entry.id);
    }
    html += fmt::format("<div><strong>{}</strong>", HtmlText(entry.name));
    if (!entry.doubts.empty()) {
      html += "<br><span class=\"doubt\">" + HtmlText("uncertain: " + entry.doubts) + "</span>";
    }
    for (const std::string& line : entry.lines) {
      if (!line.empty()) html += "<br>" + HtmlText(line);
    }
    html += "</div></li>\n";
  }
  return html + "</ul>\n";
}

std::string AndMore(size_t more) {
  return more == 0 ? "" : Faint(fmt::format("And {} more.", more));
}

// The map of a variant with the pictures of its objects.
class MapSectionBuilder {
 public:
  MapSectionBuilder(const fs::path& folder, const Sequence& sequence, const ImageSource& images)
      : folder_(folder), sequence_(sequence), images_(images) {
    map_ = ReadMap(folder / "map.json", sequence);
    std::optional<Artefact<WorldReport>> world;
    if (Exists(folder / "world.json")) world = ReadWorld(folder / "world.json");
    scale_ = ScaleFromWorld(world, sequence);
    const std::vector<std::string> doubts = DoubtsOfMap(folder, map_, sequence);
    for (size_t i = 0; i < doubts.size(); ++i) {
      if (!map_.objects[i].landmark_in_world) continue;
      placed_.push_back(&map_.objects[i]);
      doubts_.push_back(doubts[i]);
    }
  }

  // The section. Where it would be too large, pictures are left out, first those of what is not
  // placed; empty where that does not suffice.
  std::string Html(const std::string& title, size_t max_bytes, int threads) {
    std::vector<Entry> placed = PlacedEntries();
    NotPlacedEntries not_placed;
    for (const NotPlaced& thing : CollectUnplaced(folder_, map_, sequence_)) {
      if (thing.boxes.size() < 2) {
        ++not_placed.single;
      } else if (not_placed.entries.size() == kMaxNotPlaced) {
        ++not_placed.more;
      } else {
        not_placed.entries.push_back({fmt::format("seen-{}", not_placed.entries.size()),
                                      thing.label,
                                      {fmt::format("{} boxes", thing.boxes.size()), thing.reason},
                                      ChoosePicture(thing.boxes, images_, sequence_)});
      }
    }
    std::vector<Picture*> pictures;
    for (std::vector<Entry>* entries : {&placed, &not_placed.entries}) {
      for (Entry& entry : *entries) pictures.push_back(&entry.picture);
    }
    AddJpegs(pictures, kPicturePx, images_, threads);
    std::string html = MakeSection(title, placed, not_placed, "");
    for (std::vector<Entry>* entries : {&not_placed.entries, &placed}) {
      if (html.size() <= max_bytes) break;
      for (Entry& entry : *entries) entry.picture.jpeg.clear();
      html = MakeSection(title, placed, not_placed, "For lack of room pictures are left out.");
    }
    return html.size() <= max_bytes ? html : "";
  }

 private:
  // Things that are seen and not placed.
  struct NotPlacedEntries {
    std::vector<Entry> entries;
    size_t more = 0;    // things seen more often that are not in `entries`
    size_t single = 0;  // things seen once
  };

  std::string MakeSection(const std::string& title, const std::vector<Entry>& entries,
                          const NotPlacedEntries& not_placed, const std::string& note) const {
    constexpr size_t kMaxNames = 100;
    std::string html = fmt::format("<p>{} in {}.", Counted(placed_.size(), "object"),
                                   Counted(sequence_.frames.size(), "image"));
    if (!scale_.sentence.empty()) html += " " + HtmlText(scale_.sentence);
    if (sequence_.edits) html += " " + HtmlText(InWords(*sequence_.edits)) + ".";
    html += "</p>\n";
    if (!scale_.warning.empty()) {
      html += fmt::format("<p class=\"warning\">{}</p>\n", HtmlText(scale_.warning));
    }
    if (!note.empty()) html += Faint(note);
    if (!placed_.empty()) {
      html += PlanHtml(entries) + "<h3>Objects</h3>\n" +
              Faint(
                  "Width × depth × height, and by how much each may be off (95 %) if the label "
                  "is right.") +
              EntriesHtml(entries, sequence_) + AndMore(placed_.size() - entries.size());
    }
    const auto& [seen, more, single] = not_placed;
    if (!seen.empty() || single > 0) {
      html += "<h3>Seen but not placed</h3>\n";
      if (!seen.empty()) html += EntriesHtml(seen, sequence_);
      html += AndMore(more);
    }
    if (single > 0) {
      html += Faint(fmt::format(
          "{} detected in one image only.",
          single == 1 ? "One more thing was" : fmt::format("{} more things were", single)));
    }
    const std::vector<std::string>& names = sequence_.images_without_pose;
    if (!names.empty()) {
      html += fmt::format(
          "<h3>Photos without a pose</h3>\n<p>The reconstruction could not tell where {} taken; "
          "what they show is not used: {}.</p>\n",
          names.size() == 1 ? "a photo was" : fmt::format("{} photos were", names.size()),
          HtmlText(NamesInWords(names, kMaxNames)));
    }
    return Section("overview", title, html);
  }

  std::vector<Entry> PlacedEntries() const {
    const auto detections = DetectionsByObject(sequence_);
    std::vector<Entry> entries;
    for (const ObjectEstimate* estimate : placed_) {
      if (entries.size() == kMaxPlaced) break;
      const int index = estimate->object_index;
      const Object& object = sequence_.objects[index];
      Entry entry{fmt::format("picture-{}", entries.size()),
                  fmt::format("{} {}", object.label, object.id),
                  {LabelsInWords(object), SizeInWords(*estimate, scale_),
                   fmt::format("{}; {}", SupportInWords(*estimate, sequence_, map_, scale_),
                               Counted(static_cast<size_t>(estimate->observations), "view"))},
                  ChoosePicture(CollectBoxes(sequence_, detections[index]), images_, sequence_),
                  doubts_[entries.size()]};
      // The outline of the body in place of the box, if the camera sees all of it.
      const int frame = entry.picture.frame_index;
      Polygon outline;
      if (!entry.picture.part.empty()) {
        outline = OutlinePolygon(
            sequence_.CameraOf(sequence_.frames[frame]),
            Transform(map_.world_from_camera[frame].Inverse(), *estimate->landmark_in_world));
      }
      entry.picture.is_body = !outline.empty();
      if (entry.picture.is_body) entry.picture.outline = std::move(outline);
      entries.push_back(std::move(entry));
    }
    return entries;
  }

  // The plan of the segment of the first object.
  std::string PlanHtml(const std::vector<Entry>& entries) const {
    const auto segment_of_object = SegmentsOfObjects(sequence_);
    const auto segment_of = [&](const ObjectEstimate* estimate) {
      return segment_of_object[estimate->object_index].value_or(0);
    };
    const int segment = segment_of(placed_.front());
    const Eigen::Vector3d up = UpOfSegment(sequence_, segment);
    std::optional<Eigen::Vector3d> scene_axis;
    for (const SupportPlane& plane : sequence_.planes) {
      if (!scene_axis && plane.plane_in_world.normal.dot(up) > kLevel) {
        scene_axis = plane.scene_axis_in_world;
      }
    }
    std::vector<Eigen::Vector3d> centres, cameras;
    std::vector<size_t> shown;
    for (size_t i = 0; i < entries.size(); ++i) {
      if (segment_of(placed_[i]) != segment) continue;
      shown.push_back(i);
      centres.push_back(placed_[i]->landmark_in_world->Centre());
    }
    std::vector<int> frames;
    for (size_t i = 0; i < sequence_.frames.size(); ++i) {
      if (sequence_.frames[i].segment == segment) frames.push_back(static_cast<int>(i));
    }
    for (const int frame : SpreadOver(frames, kMaxWayFrames)) {
      cameras.push_back(map_.world_from_camera[frame].translation);
    }
    const PlanAxes axes = AxesOfPlan(up, scene_axis, centres, cameras);
    PlanView plan;
    plan.in_metres = scale_.in_metres;
    for (const Eigen::Vector3d& camera : cameras) plan.cameras.push_back(axes.Place(camera));
    for (const size_t i : shown) {
      const Entry& entry = entries[i];
      const Landmark& landmark = *placed_[i]->landmark_in_world;
      PlanObject object{entry.name, Footprint(landmark, axes),
                        up.dot(FindSupportPoint(landmark, up).point)};
      if (placed_[i]->FrontIsKnown()) object.front = Front(landmark, axes);
      object.is_uncertain = !entry.doubts.empty();
      if (!entry.picture.jpeg.empty()) {
        object.picture = entry.id;
        object.picture_aspect = entry.picture.part.size().aspectRatio();
      }
      plan.objects.push_back(std::move(object));
    }
    std::ranges::stable_sort(plan.objects, {}, &PlanObject::top);
    return "<figure>\n" + PlanSvg(plan, kWidePlan) + PlanSvg(plan, kNarrowPlan) + "<figcaption>" +
           Caption(plan, segment) + "</figcaption>\n</figure>\n";
  }

  std::string Caption(const PlanView& plan, int segment) const {
    const auto key = [](const char* colour, const char* text) {
      return fmt::format("<span class=\"key\" style=\"background: var(--{})\"></span> {}", colour,
                         text);
    };
    std::string caption =
        fmt::format("Seen from above. {}, {}.", key("estimate", "objects"),
                    key("detection", "path of the camera from its first place (dot)"));
    if (!std::ranges::all_of(plan.objects, &std::vector<Eigen::Vector2d>::empty,
                             &PlanObject::front)) {
      caption += " Triangles point to fronts, where they are known.";
    }
    if (std::ranges::any_of(plan.objects, &PlanObject::is_uncertain)) {
      caption +=
          " Dashed objects are uncertain: most images that should show them do not, or by their "
          "95\u00a0% intervals they may stand beside their outline, or be half or twice as large.";
    }
    const std::vector<int> segments = ListSegments(sequence_);
    if (segments.size() > 1) {
      const auto place = std::ranges::find(segments, segment) - segments.begin();
      caption += fmt::format(" Part {} of {}.", place + 1, segments.size());
    }
    return caption;
  }

  const fs::path& folder_;
  const Sequence& sequence_;
  const ImageSource& images_;
  MapEstimate map_;
  ScaleOfMap scale_;
  std::vector<const ObjectEstimate*> placed_;
  std::vector<std::string> doubts_;  // the doubts about each of placed_
};

}  // namespace

std::string MapSection(const std::string& title, const fs::path& folder, const Sequence& sequence,
                       const ImageSource& images, size_t max_bytes, int threads) {
  return MapSectionBuilder(folder, sequence, images).Html(title, max_bytes, threads);
}

}  // namespace soslam
