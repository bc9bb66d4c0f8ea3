// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

namespace soslam {

// How much of a page is made of its data.
using BytesOfPage = std::function<size_t(const nlohmann::json& data)>;

// Makes the data of a dataset's page (see PageData) no larger than max_bytes as the page has it:
// takes out the cost over yaw of single observations, then all but the numbers of variants, those
// of single frames first and maps last, and of sequences when only numbers are left. Says so in the
// data's "notes".
void FitPageData(size_t max_bytes, const BytesOfPage& bytes_of, nlohmann::json* data);

}  // namespace soslam
