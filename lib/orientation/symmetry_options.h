// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include "base/options.h"
#include "constraints/symmetry.h"
#include "constraints/variances.h"
#include "initialisation/semantic_table.h"

namespace soslam {

enum class Sampling {
  kCorners,
  kUniform,
  kCornersAndUniform,  // the best in the paper, section V-D
  kEdges,
};
inline constexpr std::array kSamplingNames = {"corners", "uniform", "corners_and_uniform", "edges"};

// Choice of the pixels of an observation to compare with their mirror pixels, and the comparison.
struct SymmetryOptions {
  Descriptor descriptor = Descriptor::kImprovedDt;
  Sampling sampling = Sampling::kCornersAndUniform;
  int max_corners = 150;
  int uniform_columns = 8;
  int max_edge_pixels = 600;
  double min_viewing_cosine = 0.4;
  int min_pairs = 8;
  double min_pair_fraction = 0.25;

  // The number of pairs that a cost needs, of so many samples on the object.
  double MinPairs(size_t samples) const {
    return std::max(static_cast<double>(min_pairs),
                    min_pair_fraction * static_cast<double>(samples));
  }

  void Describe(OptionVisitor& visit) {
    visit.Group("Texture symmetry: pairs of mirrored pixels");
    visit.Choice("descriptor", &descriptor, kDescriptorNames,
                 "what is compared between a pixel and its mirror pixel, eq. (16)-(24)");
    visit.Choice("sampling", &sampling, kSamplingNames, "which pixels are compared, section V-D");
    visit.Integer("max_corners", &max_corners, {0, 100000},
                  "at most so many corners per observation, the strongest first");
    visit.Integer("uniform_columns", &uniform_columns, {1, 1000},
                  "uniform samples: a grid of so many columns and rows over the box");
    visit.Integer("max_edge_pixels", &max_edge_pixels, {1, 1000000},
                  "edge samples: of more edge pixels in the box, every second, third, ...");
    visit.Real("min_viewing_cosine", &min_viewing_cosine, {0.0, 1.0},
               "a surface point counts as visible when the cosine between its normal and the "
               "direction to the camera is at least this");
    visit.Integer("min_pairs", &min_pairs, {1, 100000},
                  "with fewer pairs of visible points the cost is undefined");
    visit.Real("min_pair_fraction", &min_pair_fraction, {0.0, 1.0},
               "the same as a fraction of the samples on the object");
  }
};

struct RefineOptions {
  SymmetryOptions symmetry;
  double yaw_step_deg = 2.0;
  double yaw_resolution_deg = 0.1;
  double yaw_range_deg = 10.0;
  double tie_edge_px = 1.0;
  RatioPrior ratio_prior = RatioPrior::kTable;
  ConstraintVariances variances;

  void Describe(OptionVisitor& visit) {
    visit.Group("Landmarks");
    visit.Choice("ratio_prior", &ratio_prior, kRatioPriorNames,
                 "where the size ratio of eq. (11) comes from");
    visit.Group("Turned landmarks (method = turn)");
    visit.Real("yaw_step_deg", &yaw_step_deg, {0.1, 45.0},
               "grid of the cost over yaw, over half a turn");
    visit.Real("yaw_range_deg", &yaw_range_deg, {0.0, 90.0},
               "how far from a yaw that explains the box the refinement looks; 90: all around");
    visit.Real(
        "tie_edge_px", &tie_edge_px, {0.0, 1000.0},
        "all hypotheses whose outline fits the box as well as the first one's, to this rms edge "
        "distance, are tried; the texture decides");
    visit.Real("yaw_resolution_deg", &yaw_resolution_deg, {0.001, 45.0},
               "grid of the search around the best yaw of the coarse grid");
    symmetry.Describe(visit);
    variances.Describe(visit);
  }
};

}  // namespace soslam
