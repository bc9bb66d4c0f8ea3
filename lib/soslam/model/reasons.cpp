// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/reasons.h"

#include <algorithm>
#include <iterator>

#include "soslam/model/estimates.h"

namespace soslam {
namespace {

const Reason kReasons[] = {
    // Images that are not chosen.
    {"unreadable", "unreadable", "files of another format, or copied incompletely",
     "convert them to JPEG, or copy them again"},
    {"other_size", "of another size", "photos of several cameras, or upright ones among others",
     "take all photos with one camera that is held in one way"},
    {"other_focal_length", "of another focal length", "a zoom, or several lenses of one telephone",
     "take all photos with one lens, without zoom"},
    {"blurred", "blurred", "a camera that moved while the image was taken",
     "move more slowly, with more light; or lower min_sharpness"},
    // Detections that the import rejects.
    {"frame_without_pose", "in an image without a pose",
     "a trajectory of a part of the images, or of another clock",
     "compare the time stamps of images and trajectory; max_time_difference_s"},
    {"beyond_lens_model", "where no lens of this model sees",
     "distortion of another camera, or with coefficients in another order",
     "give k1, k2, p1, p2, k3 as OpenCV has them"},
    {"empty_box", "without width or height", "boxes of another convention, as x, y, width, height",
     "give corners x1, y1, x2, y2"},
    {"outside_image", "outside the image", "boxes of images of another size",
     "give boxes in pixels of the camera's image"},
    {"near_border", "too near the image border",
     "objects that the image cuts, which the paper's protocol drops",
     "a smaller border_px keeps them, with the cut edges as one-sided ones"},
    {"duplicate", "repeating another one",
     "several boxes of one object in one image, or one id for several objects",
     "an id for each object, or no ids and estimated association"},
    {"too_few_observations", "of an object with too few boxes",
     "ids that change from image to image",
     "ids that stay, or no ids and estimated association; min_observations"},
    {"without_object_id", "without object id", "a tracker that finds few tracks",
     "no object_id and estimated association"},
    // Tracks that are no objects, and objects without a landmark.
    {"too_few_detections", "seen too rarely"},
    {"undetermined", "seen too little of to tell its size and place"},
    {"no_support", "off all support planes: it may hang on a wall"},
    {"moves", "of a kind that moves"},
    {"deleted", "deleted by hand"},
    {"not_explained", "that the body of their object does not explain"},
    {"no_landmark", "without a body that fits its boxes"},
    {"no_solution", "without a body that fits its boxes"},
    {"no_finite_quadric", "without a body that fits its boxes"},
    {"no_start", "without an initial estimate"},
    {"no_ratio_for_label", "of a label that the semantic table does not have"},
    {kFewerThanThreeMeasuredEdges, "with too many edges cut off"},
    {"not_determined_by_its_views", "seen from too few sides to tell how far away it is"},
    {"collapsed", "shrunk to a point in the optimisation"},
};

}  // namespace

Reason ReasonOf(const std::string& code) {
  const auto found = std::ranges::find(kReasons, code, &Reason::code);
  if (found != std::end(kReasons)) return *found;
  Reason reason{code, code};
  std::ranges::replace(reason.words, '_', ' ');
  return reason;
}

std::map<std::string, int> ReasonsInWords(const std::map<std::string, int>& counts) {
  std::map<std::string, int> in_words;
  for (const auto& [code, count] : counts) in_words[ReasonOf(code).words] += count;
  return in_words;
}

}  // namespace soslam
