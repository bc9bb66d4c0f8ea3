// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/turn_evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "soslam/planes/camera_orientation.h"

namespace soslam {

double LogLikelihoodOfTurns(const std::vector<TurnedScores>& images) {
  // Dirichlet parameters of upright images, and of such turned clockwise by 90, 180, 270 degrees:
  // maximum likelihood over ten sequences, YOLOX-nano (docs/planes.md).
  constexpr std::array<double, kQuarterTurns> kUpright = {35.3, 8.9, 10.9, 8.9};
  const double total_of_prior = std::accumulate(kUpright.begin(), kUpright.end(), 0.0);
  std::array<double, kQuarterTurns> counts = {};  // by the turn of the copy from upright
  double in_image = 0.0;  // mean squared length of up, projected into the images
  for (const TurnedScores& image : images) {
    const Eigen::Vector3d& up = image.up_in_camera;
    in_image += up.head<2>().squaredNorm() / static_cast<double>(images.size());
    const double turns = std::atan2(up.x(), -up.y()) / (0.5 * std::numbers::pi);
    const double whole = std::floor(turns);
    const double share = std::pow(std::sin(0.5 * std::numbers::pi * (turns - whole)), 2);
    for (size_t t = 0; t < kQuarterTurns; ++t) {
      const auto turn = static_cast<size_t>(static_cast<int>(whole) + 4 + static_cast<int>(t)) % 4;
      counts[turn] += (1.0 - share) * image.scores[t];
      counts[(turn + 1) % 4] += share * image.scores[t];
    }
  }
  double sum = std::lgamma(total_of_prior) -
               std::lgamma(total_of_prior + std::accumulate(counts.begin(), counts.end(), 0.0));
  for (size_t turn = 0; turn < kQuarterTurns; ++turn) {
    const double prior =
        in_image * kUpright[turn] + (1.0 - in_image) * total_of_prior / kQuarterTurns;
    sum += std::lgamma(counts[turn] + prior) - std::lgamma(prior);
  }
  return sum;
}

Eigen::Vector3d UpOfQuarterTurn(int quarters) {
  const double angle = -0.5 * std::numbers::pi * quarters;
  return {std::sin(angle), -std::cos(angle), 0.0};
}

void ChooseTurn(ImageTurns* turns) {
  std::array<double, kQuarterTurns> logs = {};
  for (size_t turn = 0; turn < kQuarterTurns; ++turn) {
    std::vector<TurnedScores> images;
    for (const ImageTurns::Row& row : turns->images) {
      images.push_back({row.scores, UpOfQuarterTurn(static_cast<int>(turn))});
    }
    logs[turn] = LogLikelihoodOfTurns(images) - (turn == 0 ? 0.0 : kNotLevelCost);
  }
  const auto best = std::ranges::max_element(logs);
  double sum = 0.0;
  for (const double log : logs) sum += std::exp(log - *best);
  turns->upright_turn_deg = 90 * static_cast<int>(best - logs.begin());
  turns->probability = 1.0 / sum;
}

}  // namespace soslam
