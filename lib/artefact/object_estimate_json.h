// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// Nine rows of nine numbers.
nlohmann::json CovarianceToJson(const Covariance9& covariance);

// The "objects" of the landmarks and map artefacts: what all observations of each object say.
nlohmann::json ObjectEstimatesToJson(const std::vector<ObjectEstimate>& estimates,
                                     const Sequence& sequence);
// One of them, as far as it says so without the sequence: object_index stays 0.
ObjectEstimate ObjectEstimateFromJson(const nlohmann::json& row);
// Throws InputError for an object that the sequence does not have.
std::vector<ObjectEstimate> ObjectEstimatesFromJson(const nlohmann::json& json,
                                                    const Sequence& sequence);

}  // namespace soslam
