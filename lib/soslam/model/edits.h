// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "soslam/base/description.h"
#include "soslam/geometry/box.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

// The content of edits.json: corrections of data association by hand. Nothing in it is an id, as
// ids change when association runs again.

enum class EditKind { kJoin, kSplit, kDelete, kDeleteBoxes, kRename, kSize };
inline constexpr std::array kEditKindNames = {"join",         "split",  "delete",
                                              "delete_boxes", "rename", "size"};
inline constexpr const auto& NamesOf(EditKind) { return kEditKindNames; }

// A detection, by the image that it is in and the corners of its box.
struct BoxAnchor {
  std::string image;
  Box box;
};

struct Edit {
  EditKind kind = EditKind::kJoin;
  std::vector<BoxAnchor> boxes;
  std::string label = {};
  KnownSize size = {};
};

struct Edits {
  std::string description = {};
  std::vector<Edit> edits = {};
  std::string file = {};  // where they are from, for messages; not part of the file
};

// The record, in a sequence, of the edits that were applied to it.
struct AppliedEdits {
  std::map<std::string, int> kinds;  // number by name of the kind
  std::string sha256;                // of edits.json
};

// "2 corrections by hand: 1 delete, 1 rename"
std::string InWords(const AppliedEdits& edits);

template <typename Visitor>
void Describe(Visitor& visit, BoxAnchor& anchor) {
  visit.Field("image", &anchor.image,
              "file name of the image, with its folder in the dataset where another image has the "
              "same name",
              kNotEmpty);
  visit.Field("box", &anchor.box,
              "corners in the undistorted image, as sequence.json has them; the detection is the "
              "one with the largest intersection over union, at least 0.9");
}

template <typename Visitor>
void Describe(Visitor& visit, Edit& edit) {
  visit.Field("edit", &edit.kind,
              "join: the objects of these boxes are one; split: these boxes, and no others, are an "
              "object; delete: the objects of these boxes are none; delete_boxes: these boxes show "
              "nothing; rename: the objects of these boxes have this label; size: they have these "
              "lengths, to 0.5 %");
  visit.Field("boxes", &edit.boxes, "at least one, of join two", Limits{.least_items = 1});
  visit.OrAbsent("label", &edit.label, "of rename: the label, as the semantic table has it",
                 kNotEmpty);
  Describe(visit, edit.size);
  visit.Check([&] {
    const std::string name = NameOf(edit.kind);
    if (edit.kind == EditKind::kJoin && edit.boxes.size() < 2) {
      return std::string("join has one box; expected two or more");
    }
    if ((edit.kind == EditKind::kRename) == edit.label.empty()) {
      return name + (edit.label.empty() ? " has no label; expected one"
                                        : " has a label; expected none, but in rename");
    }
    if ((edit.kind == EditKind::kSize) == edit.size.Any()) return std::string();
    return name + (edit.size.Any() ? " has a length; expected none, but in size"
                                   : " has no length; expected depth_m, width_m or height_m");
  });
}

template <typename Visitor>
void Describe(Visitor& visit, Edits& edits) {
  visit.OrAbsent("description", &edits.description, "for readers of the file");
  visit.Field("edits", &edits.edits, "all of them hold at once; their order does not matter");
}

template <typename Visitor>
void Describe(Visitor& visit, AppliedEdits& edits) {
  visit.Field("kinds", &edits.kinds, "number of edits by their kind", kAtLeastOne);
  visit.Field("sha256", &edits.sha256, "SHA-256 of edits.json", kNotEmpty);
}

}  // namespace soslam
