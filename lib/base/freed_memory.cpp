// SPDX-License-Identifier: BSD-3-Clause
#include "base/freed_memory.h"

#include <cstdlib>  // says which C library it is

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace soslam {

void KeepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kMiB = 1 << 20;
  // Where the first is refused, the second would switch off what glibc does by itself.
  if (mallopt(M_MMAP_THRESHOLD, 32 * kMiB) != 0) mallopt(M_TRIM_THRESHOLD, 256 * kMiB);
#endif
}

}  // namespace soslam
