// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "soslam/constraints/image_evidence.h"
#include "soslam/constraints/image_options.h"
#include "soslam/geometry/camera.h"
#include "soslam/orientation/edge_alignment.h"
#include "soslam/orientation/symmetry.h"

namespace soslam {

// The symmetry constraint of the paper, eq. (16), of all visible pairs of pixels. `sigma`: standard
// deviation of a pair's difference, in the descriptor's unit; as in the paper, neither the weight
// of the view nor the initial landmark has to do with it.
std::shared_ptr<const ImageEvidence> MakeSymmetryEvidence(
    std::shared_ptr<const SymmetryImage> image, const Camera& camera,
    const SymmetryOptions& options, double sigma);

// The asymmetry of the texture as a bounded cost (AsymmetryCost).
std::shared_ptr<const ImageEvidence> MakeAsymmetryEvidence(
    std::shared_ptr<const SymmetryImage> image, const Camera& camera, const TextureOptions& options,
    const SymmetryOptions& symmetry_options);

// The alignment of the body's edges (EdgeCost). Where they are not visible in the image, as those
// of the cuboid of a chair, the edges that happen to be near carry no information: the weight is
// that of the detection times the square of EdgeCost::Support.
std::shared_ptr<const ImageEvidence> MakeEdgeEvidence(std::shared_ptr<const EdgeImage> image,
                                                      const Camera& camera,
                                                      const EdgeOptions& options);

}  // namespace soslam
