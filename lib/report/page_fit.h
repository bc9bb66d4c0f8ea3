// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

namespace soslam {

// Size of a page with these data.
using BytesOfPage = std::function<size_t(const nlohmann::json& data)>;

// Reduces the data of a dataset's page (see PageData) to at most max_bytes as the page stores them:
// removes the cost over yaw of single observations, then everything but the numbers of variants,
// those of single frames first and maps last, and of sequences when only numbers are left. The
// data's "notes" state what was removed.
void FitPageData(size_t max_bytes, const BytesOfPage& bytes_of, nlohmann::json* data);

}  // namespace soslam
