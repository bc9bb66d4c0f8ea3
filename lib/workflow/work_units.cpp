// SPDX-License-Identifier: BSD-3-Clause
#include "workflow/work_units.h"

#include <algorithm>
#include <iterator>

namespace soslam {
namespace {

using Ids = std::vector<std::string>;

template <typename Iterator>
void AppendNew(Iterator begin, Iterator end, Ids* ids) {
  std::copy_if(begin, end, std::back_inserter(*ids),
               [&](const std::string& id) { return std::ranges::find(*ids, id) == ids->end(); });
}

}  // namespace

std::vector<WorkUnit> WorkUnitsOf(const Plan& plan) {
  const auto takes_long = [&](const std::string& id) {
    const std::string& stage = plan.Instance(id).stage;
    return stage == "refine" || stage == "optimise";
  };
  WorkUnit trunk = {.name = kTrunk};
  std::vector<WorkUnit> branches;
  for (const VariantChain& variant : plan.variants) {
    const auto begin = variant.instances.begin();
    const auto end = variant.instances.end();
    const auto fork = std::find_if(begin, end, takes_long);
    AppendNew(begin, fork, &trunk.instances);
    if (fork == end) {
      trunk.variants.push_back(variant.name);
      continue;
    }
    auto branch = std::ranges::find(branches, *fork, &WorkUnit::name);
    if (branch == branches.end()) branch = branches.insert(branch, {.name = *fork});
    AppendNew(fork, end, &branch->instances);
    AppendNew(begin, fork, &branch->needs);
    branch->variants.push_back(variant.name);
  }
  branches.insert(branches.begin(), std::move(trunk));
  return branches;
}

}  // namespace soslam
