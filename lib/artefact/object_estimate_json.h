// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// Covariance as nine rows of nine numbers.
nlohmann::json CovarianceToJson(const Covariance9& covariance);

// The field "objects" of the artefacts "landmarks" and "map": the estimates of each object from all
// its observations.
nlohmann::json ObjectEstimatesToJson(const std::vector<ObjectEstimate>& estimates,
                                     const Sequence& sequence);
// One row of "objects", read without the sequence: object_index stays 0.
ObjectEstimate ObjectEstimateFromJson(const nlohmann::json& row);
// Throws InputError for an object that the sequence does not have.
std::vector<ObjectEstimate> ObjectEstimatesFromJson(const nlohmann::json& json,
                                                    const Sequence& sequence);

}  // namespace soslam
