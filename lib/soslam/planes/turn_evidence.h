// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "soslam/model/image_turns.h"

namespace soslam {

// Scores of an image and of its turned copies (ImageTurns::Row::scores), and the direction in which
// up would be in the camera's frame.
struct TurnedScores {
  std::array<double, kQuarterTurns> scores;
  Eigen::Vector3d up_in_camera;
};

// Log likelihood, up to a constant that is the same for all up directions, of what a detector finds
// in turned images. The scores in upright copies, in those turned by a quarter either way, and in
// those upside down, summed over all images, are Dirichlet-multinomial: shares vary from sequence
// to sequence. An image between two quarter turns counts as both; the farther down or up cameras
// look, the less one turn is preferred.
double LogLikelihoodOfTurns(const std::vector<TurnedScores>& images);

// Up in the frame of a camera whose image is upright once it is turned clockwise by so many
// quarters.
Eigen::Vector3d UpOfQuarterTurn(int quarters);

// Sets the turn that makes images upright most probably, and its probability. Images are upright
// already unless the scores say otherwise by 100 to 1.
void ChooseTurn(ImageTurns* turns);

}  // namespace soslam
