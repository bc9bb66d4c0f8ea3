// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "base/options.h"
#include "initialisation/point_term.h"
#include "initialisation/semantic_table.h"
#include "initialisation/upright_observation.h"
#include "orientation/symmetry_options.h"

namespace soslam {

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

// Parts of an observation's orientation profile besides box, ratio prior and world axes.
struct ProfileOptions {
  bool edge_alignment = true;
  bool texture_symmetry = true;
  ShapeSource shape = ShapeSource::kTable;
  UprightOptions upright;
  EdgeOptions edges;
  TextureOptions texture;
  PointOptions points;

  void Describe(OptionVisitor& visit) {
    visit.Group("Orientation profile (method = profile)");
    visit.Flag("edge_alignment", &edge_alignment,
               "use the alignment of the body's edges with the image's");
    visit.Flag("texture_symmetry", &texture_symmetry, "use the symmetry of the texture");
    visit.Choice("shape", &shape, kShapeSourceNames, "where the shape exponent comes from");
    upright.Describe(visit);
    edges.Describe(visit);
    texture.Describe(visit);
    points.Describe(visit);
  }
};

enum class RefinementMethod {
  kTurn,     // section V: the landmark is rotated to the yaw at which its texture is most symmetric
  kProfile,  // the best landmark for each yaw, and the best yaw of all
};
inline constexpr std::array kRefinementMethodNames = {"turn", "profile"};

struct OrientationOptions {
  RefinementMethod method = RefinementMethod::kTurn;
  RefineOptions turn;
  ProfileOptions profile;

  void Describe(OptionVisitor& visit) {
    visit.Group("Landmarks");
    visit.Choice("method", &method, kRefinementMethodNames,
                 "turn the initial landmark by the symmetry of its texture (section V), or find it "
                 "anew from its orientation profile");
    turn.Describe(visit);
    profile.Describe(visit);
  }
};

}  // namespace soslam
