// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <ostream>
#include <vector>

#include "soslam/association/association.h"
#include "soslam/base/error.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/initialisation/single_frame.h"
#include "soslam/initialisation/svd.h"
#include "soslam/mapping/back_end.h"
#include "soslam/mapping/initial_landmarks.h"
#include "soslam/planes/estimate_planes.h"
#include "soslam/planes/up_prior.h"
#include "support/association_scenes.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

// A way of making a sequence say little, nothing, or what cannot be.
struct Degeneracy {
  const char* name;
  std::function<void(Sequence*)> apply;
};
void PrintTo(const Degeneracy& degeneracy, std::ostream* stream) { *stream << degeneracy.name; }

// Sees every detection's plane from its frame's estimated pose.
void SeePlanesFromPoses(Sequence* sequence) {
  for (Detection& detection : sequence->detections) {
    const auto plane_index = static_cast<size_t>(sequence->ObjectOf(detection).plane_index);
    detection.plane_in_camera = Transform(sequence->FrameOf(detection).world_from_camera.Inverse(),
                                          sequence->planes[plane_index].plane_in_world);
  }
}

const Landmark& TruthOf(const Sequence& sequence, size_t object) {
  return sequence.objects[object].ground_truth->landmark_in_world;
}

// Puts every camera somewhere else, looking as before.
void MoveCameras(const std::function<Eigen::Vector3d(size_t)>& centre, Sequence* sequence) {
  for (size_t i = 0; i < sequence->frames.size(); ++i) {
    sequence->frames[i].world_from_camera.translation = centre(i);
  }
  SeePlanesFromPoses(sequence);
}

// Changes each detection.
std::function<void(Sequence*)> Each(const std::function<void(Detection*)>& change) {
  return [=](Sequence* sequence) {
    for (Detection& detection : sequence->detections) change(&detection);
  };
}

// Makes another box of each.
std::function<void(Sequence*)> Boxes(const std::function<Box(const Box&)>& other) {
  return Each([=](Detection* detection) { detection->box = other(detection->box); });
}

std::function<void(Sequence*)> Scaled(double factor) {
  return [=](Sequence* sequence) {
    for (Frame& frame : sequence->frames) frame.world_from_camera.translation *= factor;
    for (SupportPlane& plane : sequence->planes) plane.plane_in_world.offset *= factor;
    SeePlanesFromPoses(sequence);
  };
}

constexpr const char* kNoDegeneracy = "None";  // what has an answer

std::vector<Degeneracy> Degeneracies() {
  using Eigen::Vector3d;
  return {
      {kNoDegeneracy, [](Sequence*) {}},
      {"CameraInsideABody",
       [](Sequence* sequence) {
         const Vector3d inside = TruthOf(*sequence, 0).Centre() + RandomVector(-0.05, 0.05);
         MoveCameras([&](size_t) { return inside; }, sequence);
       }},
      {"BodiesBehindTheCameras",
       [](Sequence* sequence) {
         for (Frame& frame : sequence->frames) {
           frame.world_from_camera.rotation =
               frame.world_from_camera.rotation *
               Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitY()));
         }
         SeePlanesFromPoses(sequence);
       }},
      {"PlaneThroughTheCameras",
       Each([](Detection* detection) { detection->plane_in_camera.offset = 0.0; })},
      {"PlaneSeenFromItsEdge",
       [](Sequence* sequence) {
         for (Detection& detection : sequence->detections) {
           const Vector3d ray =
               sequence->CameraOf(detection).Ray(detection.box.Centre()).normalized();
           detection.plane_in_camera.normal = ray.cross(Vector3d::UnitX()).normalized();
         }
       }},
      {"GrazingPlane",
       Each([](Detection* detection) { detection->plane_in_camera.offset *= 1e-6; })},
      {"BoxesWithoutArea", Boxes([](Box box) -> Box {
         return {box.x_min, box.y_min, box.x_min, box.y_min};
       })},
      {"BoxesOfOnePixel", Boxes([](Box box) -> Box {
         return {box.x_min, box.y_min, box.x_min + 1.0, box.y_min + 1.0};
       })},
      {"BoxesThatAreLines", Boxes([](Box box) -> Box {
         return {box.x_min, box.y_min, box.x_max, box.y_min};
       })},
      {"BoxesOfTheWholeImage", Boxes([](Box) -> Box {
         return {0.0, 0.0, 639.0, 479.0};
       })},
      {"BoxesAnywhere", Boxes([](Box) -> Box {
         const double x = RandomUniform(0, 300), y = RandomUniform(0, 200);
         return {x, y, x + RandomUniform(1, 300), y + RandomUniform(1, 200)};
       })},
      {"NoEdgeIsMeasured", Each([](Detection* detection) { detection->is_one_sided.fill(true); })},
      {"CamerasOnALineThroughABody",
       [](Sequence* sequence) {
         const Vector3d from = sequence->frames.front().world_from_camera.translation;
         const Vector3d to = TruthOf(*sequence, 0).Centre();
         MoveCameras([&](size_t i) { return from + 0.01 * static_cast<double>(i) * (to - from); },
                     sequence);
       }},
      {"PureRotation",
       [](Sequence* sequence) {
         const Vector3d centre = sequence->frames.front().world_from_camera.translation;
         MoveCameras([&](size_t) { return centre; }, sequence);
       }},
      {"EveryFrameTheSame",
       [](Sequence* sequence) {
         for (Frame& frame : sequence->frames) {
           frame.world_from_camera = sequence->frames.front().world_from_camera;
         }
         SeePlanesFromPoses(sequence);
       }},
      {"OneFrame",
       [](Sequence* sequence) {
         sequence->frames.resize(1);
         std::erase_if(sequence->detections,
                       [](const Detection& detection) { return detection.frame_index > 0; });
       }},
      {"FarAway",
       [](Sequence* sequence) {
         MoveCameras([](size_t i) { return Vector3d(1e6, -1e6, 1e5 + static_cast<double>(i)); },
                     sequence);
       }},
      {"Huge", Scaled(1e6)},
      {"Tiny", Scaled(1e-6)},
      {"NoDetections", [](Sequence* sequence) { sequence->detections.clear(); }},
  };
}

constexpr int kObjects = 3;
constexpr int kFrames = 8;

// What is defined is finite; what is not has a name.
void ExpectDefined(const Landmark& landmark) {
  const Rigid3d& pose = landmark.frame_from_object;
  EXPECT_TRUE(pose.translation.allFinite() && pose.rotation.coeffs().allFinite());
  EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-6);
  EXPECT_TRUE(landmark.half_axes.allFinite() && (landmark.half_axes.array() > 0.0).all())
      << landmark.half_axes.transpose();
}

void ExpectDefined(const LandmarkEstimates& estimates) {
  for (const ObservationEstimate& observation : estimates.observations) {
    EXPECT_EQ(observation.hypotheses.empty(), !observation.failure.empty());
    for (const Hypothesis& hypothesis : observation.hypotheses) {
      ExpectDefined(hypothesis.landmark_in_camera);
      EXPECT_TRUE(std::isfinite(hypothesis.cost));
    }
  }
  for (const ObjectEstimate& object : estimates.objects) {
    EXPECT_EQ(!object.landmark_in_world, !object.failure.empty());
    if (object.landmark_in_world) ExpectDefined(*object.landmark_in_world);
  }
}

void ExpectDefined(const MapEstimate& map, int max_iterations) {
  ExpectDefined(LandmarkEstimates{{}, map.objects});
  for (const ObjectEstimate& object : map.objects) {
    if (object.covariance) {
      EXPECT_TRUE(object.covariance->allFinite());
    }
  }
  for (const Rigid3d& pose : map.world_from_camera) {
    EXPECT_TRUE(pose.translation.allFinite() && pose.rotation.coeffs().allFinite());
  }
  for (const Plane& plane : map.planes_in_world) {
    EXPECT_TRUE(plane.normal.allFinite() && std::isfinite(plane.offset));
  }
  for (const auto& [plane, covariance] : map.plane_covariances) {
    EXPECT_TRUE(covariance.allFinite());
  }
  EXPECT_TRUE(std::isfinite(map.solver.final_cost));
  EXPECT_LE(map.solver.iterations, max_iterations);
}

class DegenerateTest : public testing::TestWithParam<Degeneracy> {
 protected:
  static Sequence Make(int seed) {
    Sequence sequence = SyntheticSequence(
        RandomScene(seed, kObjects, kFrames, {Shape::kBox, Shape::kEllipsoid}), /*noise=*/false);
    GetParam().apply(&sequence);
    return sequence;
  }

  // `work` gives an answer or refuses by name; where nothing is degenerate, an answer.
  template <typename Work>
  static void ExpectAnswerOrRefusal(const Work& work, int scenes = 3) {
    for (int seed = 0; seed < scenes; ++seed) {
      SCOPED_TRACE(seed);
      const Sequence sequence = Make(seed);
      try {
        work(sequence, TrueCuboidPriors(sequence, 0.1));
      } catch (const NothingUsableError& error) {
        EXPECT_STRNE(GetParam().name, kNoDegeneracy) << error.what();
      } catch (const NumericalError& error) {
        EXPECT_STRNE(GetParam().name, kNoDegeneracy) << error.what();
      }
    }
  }
};

using Priors = std::vector<std::optional<ShapePrior>>;

TEST_P(DegenerateTest, SingleFrameEllipsoids) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors& priors) {
    std::vector<std::optional<Eigen::Vector2d>> ratios;
    for (const auto& prior : priors) ratios.emplace_back(prior->ratio);
    ExpectDefined(InitialiseSingleFrame(sequence, ratios, {}, 1));
  });
}

TEST_P(DegenerateTest, SweepOverYaw) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors& priors) {
    ExpectDefined(InitialiseUpright(sequence, priors, {}, 1));
  });
}

TEST_P(DegenerateTest, SeveralViews) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors& priors) {
    ExpectDefined(InitialiseSvd(sequence));
    ExpectDefined(InitialiseMultiView(sequence, priors, {}, 1));
  });
}

TEST_P(DegenerateTest, BackEndWithEllipsoids) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors& priors) {
    BackEndInput input{sequence, {}, priors};
    for (const Object& object : sequence.objects) {
      input.initial_landmarks.emplace_back(object.ground_truth->landmark_in_world);
    }
    const OptimiseOptions options;
    ExpectDefined(OptimiseMap(input, options), options.max_iterations);
  });
}

TEST_P(DegenerateTest, BackEndWithBodiesOfAnyShape) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors& priors) {
    OptimiseOptions options;
    options.detection_model = DetectionModel::kTangency;
    BackEndInput input{sequence, {}, priors};
    input.initial_landmarks = ChooseInitialUprightLandmarks(
        input, InitialiseUpright(sequence, priors, UprightOptions(), 1), options, 1);
    ExpectDefined(OptimiseMap(input, options), options.max_iterations);
  });
}

TEST_P(DegenerateTest, Association) {
  ExpectAnswerOrRefusal([](const Sequence& sequence, const Priors&) {
    const auto association =
        Associate(sequence, UnknowingTable(), PairEvidence(), EstimatedAssociation(), 1);
    EXPECT_EQ(association.detections.size(), sequence.detections.size());
    for (const Track& track : association.tracks) {
      if (track.fit) ExpectDefined(track.fit->landmark_in_world);
    }
  });
}

TEST_P(DegenerateTest, SupportPlanes) {
  ExpectAnswerOrRefusal(
      [](const Sequence& sequence, const Priors& priors) {
        const UpPrior up_prior = UpPriorFromCameras(PosesOf(sequence), {6.0, 30.0}, 0.3);
        const auto estimate =
            FindPlanes(sequence, priors, up_prior, PlanesOptions(), /*threads=*/1);
        if (!estimate) throw NothingUsableError("no planes");
        for (const EstimatedPlane& plane : estimate->planes) {
          EXPECT_TRUE(plane.plane_in_world.normal.allFinite());
          EXPECT_TRUE(std::isfinite(plane.plane_in_world.offset));
        }
      },
      /*scenes=*/1);
}

INSTANTIATE_TEST_SUITE_P(Scenes, DegenerateTest, testing::ValuesIn(Degeneracies()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace soslam
