// SPDX-License-Identifier: BSD-3-Clause
// Scenes and sequences for tests, made with lib/soslam/synthesis, and what may be done to them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"
#include "soslam/synthesis/simulate.h"

namespace soslam {

// A robot's drive over a level floor, forward with gentle turns, past `objects` solids of random
// size, position and yaw, with shapes drawn from `shapes`. Objects do not touch; each has its own
// label and is in sight in at least three frames (in all, if there are fewer). Without noise; the
// caller may set it. The same arguments give the same scene.
Scene RandomScene(int seed, int objects, int frames,
                  const std::vector<Shape>& shapes = {Shape::kEllipsoid});

// The simulation as a sequence in memory, with ground truth, without false boxes and without images
// on disk. Each detection has its support plane as the true camera sees it.
Sequence SyntheticSequence(const Scene& scene, bool noise);

// Cuboids on a floor of any yaw that a robot drives past, with exact boxes and true poses.
Sequence CuboidSequence(int objects, int frames);

// Objects of all shapes, with these labels in turn, that a robot drives past.
Scene LabelledScene(int seed, int objects, int frames, const std::vector<std::string>& labels);

// Noise of an ordinary detector, and of the odometry that AssociateOptions are meant for.
SceneNoise OrdinaryNoise();

// Each object's true ratio, known to log_sigma, and a cuboid's shape.
std::vector<std::optional<ShapePrior>> TrueCuboidPriors(const Sequence& sequence, double log_sigma);

// The scene with the objects of odd index on a shelf this much higher (m).
Scene WithShelf(Scene scene, double height);

// The scene with the objects of odd index hanging from a ceiling at this height (m) over where they
// stood.
Scene WithCeiling(Scene scene, double height);

// The sequence with all planes turned by a degree or so and raised by 5 cm, as if estimated, under
// hardly any knowledge of up.
Sequence OnPlanesToEstimate(Sequence sequence);

// The sequence in another world.
Sequence TransformSequence(const Rigid3d& new_from_old, Sequence sequence);

// Posts and mats, each label twice, whose boxes are no objects' yet.
Sequence PostsAndMats();

// `log_sigma`: of ratios and heights.
SemanticTable TableOfPostsAndMats(double log_sigma = 0.3);

// The sequence of cameras that are turned clockwise about their optical axes by this many quarters.
Sequence Rolled(Sequence sequence, int quarters);

}  // namespace soslam
