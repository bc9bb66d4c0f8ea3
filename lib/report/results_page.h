// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "base/table.h"

namespace soslam {

// A page of prose with tables in it, each between two lines
//
//     <!-- table: NAME -->
//     <!-- end: SHA-256 of the lines between -->
//
// or, before the page is filled for the first time, "<!-- end -->" as the second.

// The page with the present tables between its markers. `name` of the page is for messages. Throws
// InputError for a table that there is not and for markers without their other half.
std::string FillPage(const std::string& page, const std::vector<Table>& tables,
                     const std::string& name);

// Names of the tables in a page that are not as FillPage left them.
std::vector<std::string> EditedTables(const std::string& page, const std::string& name);

}  // namespace soslam
