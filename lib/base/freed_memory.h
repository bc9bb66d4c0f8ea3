// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace soslam {

// From now on blocks below 32 MiB stay with the program when they are freed, up to 256 MiB of them
// in the main thread and about 64 MiB in each other one (glibc's limit): programs that work on one
// image after the other want as large ones again. From the system they would come page by page,
// each cleared first. With other C libraries than glibc nothing changes.
void KeepFreedMemory();

}  // namespace soslam
