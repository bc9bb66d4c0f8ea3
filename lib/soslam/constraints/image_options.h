// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "soslam/base/options.h"

namespace soslam {

// Descriptors that are compared between a pixel and its mirror pixel, section V-B.
enum class Descriptor {
  kGrey,               // grey value, 0 to 1
  kBrief,              // Hamming distance of BRIEF, mirrored sampling order; 0 to 1, no derivative
  kFreak,              // the same for FREAK, which the paper leaves as future work
  kDistanceTransform,  // eq. (17): distance to the nearest edge in the image, px
  kNearestEdge3d,  // eq. (19): distance to the nearest edge on the surface, m; exhaustive search
  kImprovedDt,     // eq. (20)-(22): distance on the surface to the nearest edge in the image, m
  kLinearisedDt,   // eq. (23)-(24): the same on the tangent plane of the surface, m
};
inline constexpr std::array kDescriptorNames = {"grey",
                                                "brief",
                                                "freak",
                                                "distance_transform",
                                                "nearest_edge_3d",
                                                "improved_dt",
                                                "improved_dt_linearised"};

// Binary descriptors have none: they can refine a yaw, but not take part in the back end.
inline bool HasDerivative(Descriptor descriptor) {
  return descriptor != Descriptor::kBrief && descriptor != Descriptor::kFreak;
}

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

// Comparison of an object's projected edges with those of the image.
struct EdgeOptions {
  double edge_sigma_px = 2.0;
  double edge_truncation_px = 8.0;
  double edge_direction_tolerance_deg = 20.0;
  double edge_spacing_px = 4.0;
  double edge_correlation_px = 60.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Edge alignment (edges of a body and of the image)");
    visit.Real("edge_sigma_px", &edge_sigma_px, {0.1, 100.0},
               "standard deviation of the distance between an edge of the body and its image");
    visit.Real("edge_truncation_px", &edge_truncation_px, {0.1, 1000.0},
               "distances well beyond this count no more than this");
    visit.Real("edge_direction_tolerance_deg", &edge_direction_tolerance_deg, {0.0, 90.0},
               "image edges that run in another direction than the body's count as far away");
    visit.Real("edge_spacing_px", &edge_spacing_px, {0.5, 100.0},
               "distance between the points of an edge that are compared");
    visit.Real("edge_correlation_px", &edge_correlation_px, {1.0, 1e6},
               "points closer than this say the same: all points of a detection count as its box's "
               "perimeter divided by this");
  }
};

// Comparison of the texture with its mirror image, as evidence for a yaw.
struct TextureOptions {
  double asymmetry_cost = 2.0;
  double asymmetry_scale = 0.03;
  double asymmetry_scale_px = 3.0;
  double mirror_plane_range = 0.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Texture asymmetry and mirror planes");
    visit.Real("asymmetry_cost", &asymmetry_cost, {0.0, 1e6},
               "negative log likelihood of a texture that is not symmetric");
    visit.Real("asymmetry_scale", &asymmetry_scale, {1e-6, 1e6},
               "descriptor difference of a pair that counts as not symmetric, as a fraction of the "
               "object's size (the cubic root of its half axes' product), of the range of grey "
               "values, or of the bits of BRIEF or FREAK");
    visit.Real("asymmetry_scale_px", &asymmetry_scale_px, {1e-3, 1e6},
               "the same for descriptor = distance_transform");
    visit.Real("mirror_plane_range", &mirror_plane_range, {0.0, 10.0},
               "how far to either side of a landmark's centre its mirror plane may lie, as a "
               "fraction of its size: a box says less about that than the texture");
  }
};

}  // namespace soslam
