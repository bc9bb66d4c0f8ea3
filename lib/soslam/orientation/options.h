// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "soslam/base/options.h"
#include "soslam/constraints/image_options.h"
#include "soslam/constraints/object_point.h"
#include "soslam/constraints/variances.h"
#include "soslam/initialisation/upright_options.h"
#include "soslam/model/semantic_table.h"

namespace soslam {

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
    DescribeRatioPrior(visit, &ratio_prior);
    visit.OnlyWhere({{"method", {"turn"}}}, [&] {
      visit.Group("Turned landmarks");
      visit.Real("yaw_step_deg", &yaw_step_deg, {0.1, 45.0},
                 "grid of the cost over yaw, over half a turn");
      visit.Real("yaw_range_deg", &yaw_range_deg, {0.0, 90.0},
                 "how far from a yaw that explains the box the refinement looks; 90: all around");
      visit.Real("tie_edge_px", &tie_edge_px, {0.0, 1000.0},
                 "all hypotheses whose outline fits the box as well as the first one's, to this "
                 "rms edge distance, are tried; the texture decides");
      visit.Real("yaw_resolution_deg", &yaw_resolution_deg, {0.001, 45.0},
                 "grid of the search around the best yaw of the coarse grid");
    });
    symmetry.Describe(visit);
    visit.OnlyWhere({{"method", {"turn"}}}, [&] { variances.Describe(visit); });
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
  PictureOptions pictures;

  void Describe(OptionVisitor& visit) {
    visit.Group("Orientation profile");
    visit.Flag("edge_alignment", &edge_alignment,
               "use the alignment of the body's edges with the image's");
    visit.Flag("texture_symmetry", &texture_symmetry, "use the symmetry of the texture");
    DescribeShape(visit, &shape);
    upright.Describe(visit);
    visit.OnlyWhere({{"edge_alignment", {"true"}}}, [&] { edges.Describe(visit); });
    visit.OnlyWhere({{"texture_symmetry", {"true"}}}, [&] { texture.Describe(visit); });
    points.Describe(visit);
    pictures.Describe(visit);
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
    visit.OnlyWhere({{"method", {"profile"}}}, [&] { profile.Describe(visit); });
  }
};

}  // namespace soslam
