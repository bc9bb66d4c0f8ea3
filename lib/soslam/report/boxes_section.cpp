// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/report/page_html.h"
#include "soslam/report/page_parts.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxSheets = 100;
constexpr size_t kMaxCrops = 24;  // of an object
constexpr int kCropPx = 96;       // at most, of width and height

// A box of an object, or near it. `mark`: why it is not used; empty where it is.
struct SheetBox {
  std::string mark;
  Box box;
  Picture picture;
};

// The boxes of an object, or some of them, spread over the frames.
struct Sheet {
  std::string name;
  std::string evidence;  // what held it together, in words
  size_t boxes = 0, unused = 0;
  std::vector<SheetBox> shown = {};
  std::optional<SheetBox> kept_out = {};  // of the nearest track that was not taken in
};

std::string CountedBoxes(size_t count) {
  return count == 1 ? "1 box" : fmt::format("{} boxes", count);
}

std::string PointsInWords(const Associations::Evidence& evidence) {
  return fmt::format("{} of {} points", evidence.points_in_both, evidence.points_in_any);
}

// The weakest pair of an object's boxes, and the nearest track that was kept out of it.
std::string EvidenceInWords(const Associations& associations, int object) {
  std::string words;
  const auto is_of = [object](const auto& row) { return row.object == object; };
  const auto weakest = std::ranges::find_if(associations.held_least, is_of);
  if (weakest != associations.held_least.end()) {
    words += fmt::format("Held least by {} of frames {} and {}. ", PointsInWords(weakest->evidence),
                         weakest->one.frame, weakest->other.frame);
  }
  const auto nearest = std::ranges::find_if(associations.kept_out, is_of);
  if (nearest == associations.kept_out.end()) return words;
  const auto other =
      std::ranges::find(associations.objects, nearest->track, &Associations::ObjectRow::track);
  const auto box = std::ranges::find(associations.detections, nearest->track,
                                     &Associations::DetectionRow::track);
  const auto& [both, any, points, colours, body, labels] = nearest->evidence;
  return words + fmt::format(
                     "Kept out, the nearest: {} with {}, by log odds of {:.1f} ({}: {:.1f}; "
                     "colours {:.1f}, body {:.1f}, labels {:.1f}); {} with both.",
                     other == associations.objects.end() ? box->label + ", left out"
                                                         : ObjectName(other->label, other->object),
                     CountedBoxes(static_cast<size_t>(nearest->boxes)),
                     points + colours + body + labels, PointsInWords(nearest->evidence), points,
                     colours, body, labels,
                     Counted(static_cast<size_t>(nearest->frames_with_both), "frame"));
}

std::vector<Sheet> MakeSheets(const Associations& associations, const Sequence& sequence,
                              const ImageSource& images) {
  std::map<std::pair<int, int>, int> track_of;  // by the name of a detection
  for (const Associations::DetectionRow& row : associations.detections) {
    if (row.track) track_of[{row.name.frame, row.name.given_object}] = *row.track;
  }
  const auto box_of = [&](const Associations::DetectionName& name, const std::string& mark) {
    const SeenBox seen = FindSeenBox(name, sequence);
    const Camera& camera = sequence.CameraOf(sequence.frames[seen.frame_index]);
    SheetBox box = {mark, seen.box, PictureOfBox(seen.frame_index, seen.box, camera)};
    if (!images.has(seen.frame_index)) box.picture.part = {0, 0, camera.width, camera.height};
    return box;
  };
  std::map<int, std::vector<SheetBox>> boxes_of;  // by track
  for (const Associations::DetectionRow& row : associations.detections) {
    const Associations::DetectionName& name = row.duplicate_of.value_or(row.name);
    const auto track = track_of.find({name.frame, name.given_object});
    if (track == track_of.end()) continue;
    const bool is_used = row.fate == BoxFate::kExplained || row.fate == BoxFate::kAlone ||
                         row.fate == BoxFate::kByHand;
    boxes_of[track->second].push_back(box_of(row.name, is_used ? "" : NameOf(row.fate)));
  }
  std::vector<Sheet> sheets;
  for (const Associations::ObjectRow& row : associations.objects) {
    if (sheets.size() == kMaxSheets) break;
    const auto object = std::ranges::find(sequence.objects, row.object, &Object::id);
    Sheet sheet = {
        ObjectName(object == sequence.objects.end() ? row.label : object->label, row.object),
        EvidenceInWords(associations, row.object)};
    sheet.shown = std::move(boxes_of[row.track]);
    sheet.boxes = sheet.shown.size();
    sheet.unused =
        sheet.boxes - static_cast<size_t>(std::ranges::count(sheet.shown, "", &SheetBox::mark));
    const auto nearest =
        std::ranges::find(associations.kept_out, row.object, &Associations::KeptOutRow::object);
    if (nearest != associations.kept_out.end()) {
      sheet.kept_out = box_of(nearest->nearest, "kept out");
    }
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

// Leaves so many boxes on each sheet, evenly spread.
void Thin(size_t count, std::vector<Sheet>* sheets) {
  for (Sheet& sheet : *sheets) {
    const size_t all = sheet.shown.size();
    if (all <= count) continue;
    std::vector<SheetBox> some;
    for (size_t i = 0; i < count; ++i) some.push_back(std::move(sheet.shown[i * all / count]));
    sheet.shown = std::move(some);
  }
}

std::string SheetHtml(const Sheet& sheet, const Sequence& sequence) {
  std::string counts = CountedBoxes(sheet.boxes);
  if (sheet.unused > 0) counts += fmt::format(", {} not used", sheet.unused);
  if (sheet.shown.size() < sheet.boxes) {
    counts += fmt::format("; {} of them are shown", sheet.shown.size());
  }
  std::string html = fmt::format("<h3>{}</h3>\n{}<div class=\"sheet\">\n", HtmlText(sheet.name),
                                 Faint(counts + ". " + sheet.evidence));
  const auto figure = [&](const SheetBox& shown) {
    const auto& [mark, box, picture] = shown;
    const Frame& frame = sequence.frames[picture.frame_index];
    const bool has_name = !frame.image.empty();
    const std::string name =
        has_name ? fmt::format("{}: {}", frame.id, fs::path(frame.image).filename().string())
                 : fmt::format("{}", frame.id);
    // The name of a box for other programs: {"image": "rgb/7.png", "box": [10, 20, 30, 40]}.
    const std::string anchor =
        fmt::format("{{\"image\": {}, \"box\": [{:.1f}, {:.1f}, {:.1f}, {:.1f}]}}",
                    JsonText(frame.image), box.x_min, box.y_min, box.x_max, box.y_max);
    return fmt::format(
        "<figure{}>{}<figcaption><details><summary>{}{}</summary><code>{}</code></details>"
        "</figcaption></figure>\n",
        mark.empty() ? "" : " class=\"unused\"",
        PictureSvg(picture, sheet.name + " in frame " + name, ""),
        mark.empty() ? "" : fmt::format("<strong>{}</strong> ", mark), HtmlText(name),
        has_name ? HtmlText(anchor) : "It has no image.");
  };
  for (const SheetBox& box : sheet.shown) html += figure(box);
  if (sheet.kept_out) html += figure(*sheet.kept_out);
  return html + "</div>\n";
}

}  // namespace

std::string BoxesSection(const fs::path& folder, const Sequence& sequence,
                         const ImageSource& images, size_t max_bytes, int threads) {
  if (!Exists(folder / "associations.json")) return "";
  const Associations associations = ReadAssociations(folder / "associations.json").body;
  std::vector<Sheet> sheets = MakeSheets(associations, sequence, images);
  Thin(kMaxCrops, &sheets);
  std::vector<Picture*> pictures;
  for (Sheet& sheet : sheets) {
    for (SheetBox& box : sheet.shown) pictures.push_back(&box.picture);
    if (sheet.kept_out) pictures.push_back(&sheet.kept_out->picture);
  }
  AddJpegs(pictures, kCropPx, images, threads);
  for (size_t count = kMaxCrops; count > 0; count /= 2) {
    Thin(count, &sheets);
    std::string html =
        "<p class=\"faint\">All that association took to be of one object. Marked ones are not "
        "used: second: another box of "
        "the frame fits better; unexplained: far from where the object's body would be; duplicate: "
        "another box covers it. The last one is of the track that came nearest and was kept out. "
        "Numbers and names of frames open the text that names the box.</p>\n";
    for (const Sheet& sheet : sheets) html += SheetHtml(sheet, sequence);
    if (sheets.size() < associations.objects.size()) {
      html +=
          Faint(fmt::format("And {} more objects.", associations.objects.size() - sheets.size()));
    }
    html = Section("boxes", "Boxes of each object", html);
    if (html.size() <= max_bytes) return html;
  }
  return "";
}

}  // namespace soslam
