// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "soslam/base/options.h"
#include "soslam/model/sequence.h"
#include "soslam/planes/options.h"

namespace soslam {

enum class AssociationSource {
  kGiven,      // the dataset gives the object of each box
  kEstimated,  // the dataset does not, or it is ignored
};
inline constexpr std::array kAssociationSourceNames = {"given", "estimated"};

// Fits of bodies to the boxes of tracks, whose errors are also those of the label's shape.
inline constexpr UprightOptions kUprightTracks{
    .detection_sigma_fraction = 0.05, .axes_weight = 0.0, .yaw_grid_deg = 10.0};

struct AssociateOptions {
  AssociationSource association = AssociationSource::kGiven;
  bool use_planes = true;
  CameraTilt tilt;
  double unknown_height_m = 0.4;
  UprightOptions upright = kUprightTracks;
  double cut_edge_probability = 0.05;
  double new_object_probability = 0.05;
  double label_confusion = 0.05;
  std::string interchangeable_labels;
  std::string similar_labels =
      "chair, armchair, office chair, high chair, stool, bar stool, pouf, bench, coffee table, "
      "side table; "
      "sofa, couch, armchair, bench, bed; "
      "dining table, table, coffee table, desk, side table, bench; "
      "suitcase, trunk, box, crate, chest of drawers, nightstand; "
      "refrigerator, oven, microwave, cabinet, chest of drawers, cupboard, wardrobe, dishwasher, "
      "washing machine, tv stand; "
      "tv, monitor, laptop, microwave; "
      "cup, bowl, mug, glass, can, jar, vase, pot; "
      "bottle, vase, can, jar, milk carton, wine bottle; "
      "vase, potted plant; "
      "cell phone, remote, phone, mouse, book; "
      "book, box, laptop, notebook, cell phone; "
      "car, van, truck, bus";
  double similar_label_confusion = 0.02;
  std::string moving_labels = kMovingLabels;  // of the sequence; not a setting of this stage
  double label_evidence_weight = 0.5;
  double no_support_probability = 0.1;
  double odometry_rotation_sigma_deg = 0.1;
  double odometry_translation_sigma_m = 0.003;
  double duplicate_overlap = 0.85;
  double same_place_overlap = 0.5;
  int min_observations = 3;
  double min_overlap_by_boxes = 0.25;
  double min_detection_share = 0.1;
  double min_best_score = 0.35;
  int max_views = 16;
  bool shared_points = false;

  void Describe(OptionVisitor& visit) {
    visit.Group("Association");
    visit.Choice("association", &association, kAssociationSourceNames,
                 "whether the dataset says which detection is of which object, or this stage finds "
                 "it out; the stage runs only in the latter case");
    visit.Real("label_confusion", &label_confusion, {0.0, 0.5},
               "the share of detections with another label than their object's; 0: a detection is "
               "linked to an object of its own label only");
    visit.Text("interchangeable_labels", &interchangeable_labels,
               "labels that count as the same, groups of comma-separated labels, separated by "
               "semicolons: 'cup, bowl; tv, monitor'");
    visit.Text("similar_labels", &similar_labels,
               "labels that detectors confuse, groups as in interchangeable_labels; a label may be "
               "in several groups. The boxes of an object decide among the labels that it is "
               "detected with and those similar to them");
    visit.Real("similar_label_confusion", &similar_label_confusion, {0.0, 0.5},
               "the share of detections with a label that is similar to that of their object");
    visit.Real(
        "label_evidence_weight", &label_evidence_weight, {0.0, 1.0},
        "weight of boxes and sizes beside the votes of labels: errors of a label's shape are "
        "the same in all views");
    visit.Real("new_object_probability", &new_object_probability, {1e-6, 0.5},
               "the share of detections that are of no object seen before");
    visit.Real("duplicate_overlap", &duplicate_overlap, {0.0, 1.0},
               "of two boxes in one frame whose intersection over union is at least this, the one "
               "with the lower score is dropped");
    visit.Group("Boxes");
    upright.DescribeSigmaAboutBody(
        visit,
        "standard deviation of a box edge about that of the object's body, as a fraction of the "
        "box's width or height, at least 1 px: the errors of the detector and of the label's "
        "shape");
    visit.Real("cut_edge_probability", &cut_edge_probability, {0.0, 0.2},
               "how often an edge of a box is not the object's, because something unknown hides "
               "that side or adds to it; for each of the four edges");
    upright.DescribeViewCorrelation(visit);
    visit.Integer("max_views", &max_views, {1, 100000},
                  "how many of its detections, evenly over all, an object's landmark is fitted to");
    upright.DescribeYawGrid(visit, "grid of the sweep over half a turn when a landmark is fitted");
    visit.Group("Odometry");
    visit.Real("odometry_rotation_sigma_deg", &odometry_rotation_sigma_deg, {0.0, 180.0},
               "standard deviation of the odometry between two frames");
    visit.Real("odometry_translation_sigma_m", &odometry_translation_sigma_m, {0.0, 1e3},
               "standard deviation of the odometry between two frames, per axis");
    visit.Group("Support planes");
    visit.Flag("use_planes", &use_planes,
               "boxes are linked on the support planes of the dataset, where it has any; without "
               "planes objects stand at any height, and the result has no planes");
    visit.Real("no_support_probability", &no_support_probability, {1e-9, 1.0},
               "the share of objects that stand on none of the planes, as pictures on a wall do; "
               "they get no place in the map");
    tilt.Describe(visit, "without planes: ");
    visit.Real("unknown_height_m", &unknown_height_m, {1e-6, 1e6},
               "without planes: height of objects whose label has none in the semantic table; its "
               "standard deviation is a factor of e");
    visit.Group("Points");
    visit.Flag("shared_points", &shared_points,
               "points that several images show (soslam-match) tell which boxes show the same "
               "object; needs images");
    visit.Group("Objects at one place, and false ones");
    visit.Real("same_place_overlap", &same_place_overlap, {0.0, 1.0},
               "two bodies that share at least this fraction of the smaller one's volume are at "
               "one place, where two objects of like labels hardly are");
    visit.Integer("min_observations", &min_observations, {1, 1000000},
                  "objects with fewer detections are false");
    visit.Real("min_overlap_by_boxes", &min_overlap_by_boxes, {0.0, 1.0},
               "objects that no image shows whole are false if their boxes alone, without the "
               "sizes of a label, determine less of their body: expected intersection over union "
               "of the body with one that the boxes allow");
    visit.Real("min_detection_share", &min_detection_share, {0.0, 1.0},
               "objects that are detected in a smaller share of the frames that should show them "
               "are false");
    visit.Real("min_best_score", &min_best_score, {0.0, 1.0},
               "objects none of whose detections has at least this score are false");
  }
};

}  // namespace soslam
