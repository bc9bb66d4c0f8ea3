// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "soslam/base/options.h"
#include "soslam/constraints/object_point.h"
#include "soslam/initialisation/cuboid_options.h"
#include "soslam/initialisation/single_frame.h"
#include "soslam/initialisation/upright_options.h"
#include "soslam/initialisation/yaw_prior.h"
#include "soslam/model/semantic_table.h"

namespace soslam {

enum class InitialisationMethod {
  kSingleFrame,      // one landmark per observation, as in section IV of the paper
  kYawSweep,         // one landmark per observation, of any shape, closed form at each yaw
  kMultiView,        // one landmark per object from all of its observations, of any shape
  kSvd,              // QuadricSLAM: one landmark per object from all of its observations
  kCuboidProposals,  // CubeSLAM: one cuboid per observation, chosen by the edges in the image
};
inline constexpr std::array kInitialisationMethodNames = {"single_frame", "yaw_sweep", "multi_view",
                                                          "svd", "cuboid_proposals"};

struct InitialiseOptions {
  InitialisationMethod method = InitialisationMethod::kSingleFrame;
  RatioPrior ratio_prior = RatioPrior::kTable;
  ShapeSource shape = ShapeSource::kTable;
  SingleFrameOptions single_frame;
  UprightOptions upright;
  YawPriorOptions yaw_prior;
  PointOptions points;
  PictureOptions pictures;
  CuboidOptions cuboids;

  void Describe(OptionVisitor& visit) {
    visit.Group("Landmarks");
    visit.Choice(
        "method", &method, kInitialisationMethodNames,
        "one landmark per observation: an ellipsoid as in section IV (single_frame), a body of the "
        "label's shape by a sweep over yaw (yaw_sweep), or a cuboid that fits the edges in the "
        "image as in CubeSLAM (cuboid_proposals); or one per object from all of its "
        "observations: such a body (multi_view), or an ellipsoid by SVD (svd)");
    visit.OnlyWhere({{"method", {"single_frame", "yaw_sweep", "multi_view"}}},
                    [&] { DescribeRatioPrior(visit, &ratio_prior); });
    visit.OnlyWhere({{"method", {"single_frame"}}}, [&] { single_frame.Describe(visit); });
    visit.OnlyWhere({{"method", {"yaw_sweep", "multi_view"}}}, [&] {
      upright.Describe(visit);  // the options up to yaw_prior belong to its group
      DescribeShape(visit, &shape);
    });
    visit.OnlyWhere({{"method", {"multi_view"}}, {"yaw_prior", {"motion"}}},
                    [&] { upright.DescribeViewCorrelation(visit); });
    visit.OnlyWhere({{"method", {"yaw_sweep"}}}, [&] { yaw_prior.Describe(visit); });
    points.Describe(visit);
    visit.OnlyWhere({{"method", {"yaw_sweep", "multi_view"}}}, [&] { pictures.Describe(visit); });
    visit.OnlyWhere({{"method", {"cuboid_proposals"}}}, [&] { cuboids.Describe(visit); });
  }
};

}  // namespace soslam
