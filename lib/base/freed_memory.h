// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace soslam {

// From now on memory that is freed stays with the program, up to a limit: programs that work on one
// image after the other free large blocks and want as large ones again. From the system they would
// come page by page, each cleared first. With other C libraries than glibc nothing changes.
void KeepFreedMemory();

}  // namespace soslam
