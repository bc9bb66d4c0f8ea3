// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz_target.h"
#include "priors/furniture_catalogue.h"

namespace soslam {
namespace {

const FuzzTarget kCatalogue("catalogue", [](const HostileInput& input) {
  const auto file = input.AsFile("catalogue");
  IsAccepted(file, [&] { ReadFurnitureCatalogue(file); });
  IsAccepted(file, [&] { ReadCatalogueNames(file); });
});

}  // namespace
}  // namespace soslam
