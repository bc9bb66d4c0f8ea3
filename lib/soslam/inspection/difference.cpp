// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/inspection/difference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/inspection/inspection.h"

namespace soslam {
namespace {

using nlohmann::json;

// Appends the numbers of nested arrays; false if there is anything other than numbers.
bool Flatten(const json& value, std::vector<double>* numbers) {
  if (value.is_number()) numbers->push_back(value.get<double>());
  if (!value.is_array()) return value.is_number();
  return std::ranges::all_of(value, [&](const json& item) { return Flatten(item, numbers); });
}

bool HaveOneShape(const json& one, const json& two) {
  if (!one.is_array() || !two.is_array()) return one.is_array() == two.is_array();
  return one.size() == two.size() && std::equal(one.begin(), one.end(), two.begin(), &HaveOneShape);
}

// Collects the differences of two documents or files.
class Comparison {
 public:
  Comparison(double tolerance, std::vector<Difference>* differences)
      : tolerance_(tolerance), differences_(differences) {}

  void Compare(const json& one, const json& two, const json::json_pointer& place) {
    std::vector<double> numbers, others;
    if (HaveOneShape(one, two) && Flatten(one, &numbers) && Flatten(two, &others)) {
      CompareNumbers(place.to_string(), numbers, others);
    } else if (one.is_object() && two.is_object()) {
      const auto find = [](const json& object, const std::string& key) {
        return object.contains(key) ? &object[key] : nullptr;
      };
      std::set<std::string> keys;
      for (const json* object : {&one, &two}) {
        for (const auto& item : object->items()) keys.insert(item.key());
      }
      for (const std::string& key : keys) CompareItems(find(one, key), find(two, key), place / key);
    } else if (one.is_array() && two.is_array()) {
      for (size_t i = 0; i < std::max(one.size(), two.size()); ++i) {
        CompareItems(i < one.size() ? &one[i] : nullptr, i < two.size() ? &two[i] : nullptr,
                     place / i);
      }
    } else if (one != two) {
      Report(place.to_string(), Excerpt(one), Excerpt(two));
    }
  }

  // Compares a group of two HDF5 files, which ends in a slash and is in both.
  void CompareGroup(const Hdf5File& one, const Hdf5File& two, const std::string& group) {
    Compare(Attributes(one, group), Attributes(two, group),
            json::json_pointer(group.substr(0, group.size() - 1)));
    const std::vector<std::string> names = one.Children(group), others = two.Children(group);
    std::set<std::string> all(names.begin(), names.end());
    all.insert(others.begin(), others.end());
    for (const std::string& name : all) {
      const std::string place = group + name;
      const std::string kind = KindOf(one, place), other_kind = KindOf(two, place);
      if (kind.empty() || other_kind.empty()) {
        Report(place, kind.empty() ? "" : "present", other_kind.empty() ? "" : "present");
      } else if (kind != other_kind) {
        Report(place, kind, other_kind);
      } else if (one.IsGroup(place)) {
        CompareGroup(one, two, place + "/");
      } else {
        CompareDataSets(one.ReadNumbers(place), two.ReadNumbers(place), place);
      }
    }
  }

 private:
  void Report(const std::string& place, const std::string& one, const std::string& two) {
    differences_->push_back({place, one, two, {}, {}});
  }

  // Compares two arrays of the same length.
  void CompareNumbers(const std::string& place, const std::vector<double>& one,
                      const std::vector<double>& two) {
    Difference found{place, "", "", 0.0, 0.0, 0, one.size()};
    for (size_t i = 0; i < one.size(); ++i) {
      if (one[i] == two[i] || (std::isnan(one[i]) && std::isnan(two[i]))) continue;
      const double absolute = std::abs(one[i] - two[i]);
      const double size = std::max(std::abs(one[i]), std::abs(two[i]));
      if (std::isfinite(size) && absolute <= tolerance_ * std::max(size, 1.0)) continue;
      ++found.differing;
      // NaN counts as a larger difference than any other.
      if (found.one.empty() || absolute > *found.absolute || std::isnan(absolute)) {
        found.absolute = absolute;
        found.one = fmt::format("{}", one[i]);
        found.two = fmt::format("{}", two[i]);
      }
      found.relative = std::max(*found.relative, absolute / size);
    }
    if (found.differing > 0) differences_->push_back(found);
  }

  // A null pointer means that only the other artefact has the item.
  void CompareItems(const json* one, const json* two, const json::json_pointer& place) {
    if (one != nullptr && two != nullptr) return Compare(*one, *two, place);
    const auto text = [](const json* value) { return value == nullptr ? "" : Excerpt(*value); };
    Report(place.to_string(), text(one), text(two));
  }

  // Empty where there is nothing.
  static std::string KindOf(const Hdf5File& file, const std::string& place) {
    if (!file.Has(place)) return "";
    return file.IsGroup(place) ? "group" : "data set";
  }

  // All attributes except the artefact's header.
  static json Attributes(const Hdf5File& file, const std::string& owner) {
    json attributes = json::object();
    for (const std::string& name : file.Attributes(owner)) {
      if (owner == "/" && name == kHeaderAttribute) continue;
      attributes[name] = file.IsText(owner, name) ? json(file.ReadText(owner, name))
                                                  : json(file.ReadNumber(owner, name));
    }
    return attributes;
  }

  void CompareDataSets(const Hdf5File::Numbers& one, const Hdf5File::Numbers& two,
                       const std::string& place) {
    if (one.shape == two.shape) return CompareNumbers(place, one.values, two.values);
    const auto shape_in_words = [](const Hdf5File::Numbers& numbers) {
      return fmt::format("{} values", fmt::join(numbers.shape, " x "));
    };
    Report(place, shape_in_words(one), shape_in_words(two));
  }

  double tolerance_;
  std::vector<Difference>* differences_;
};

Value NumberCell(const std::optional<double>& number) {
  return number ? Value(fmt::format("{:.3g}", *number)) : Value();
}

Value TextCell(const std::string& text) { return text.empty() ? Value() : Value(text); }

std::string FormatPlaces(const std::vector<Difference>& places, bool is_coloured) {
  ValueTable table;
  table.columns = {{"place"}, {"one"}, {"two"}, {"absolute"}, {"relative"}, {"numbers"}};
  for (const Difference& place : places) {
    table.rows.push_back(
        {place.place, TextCell(place.one), TextCell(place.two), NumberCell(place.absolute),
         NumberCell(place.relative),
         place.of > 1 ? Value(fmt::format("{} of {}", place.differing, place.of)) : Value()});
  }
  return FormatTable(table, is_coloured);
}

}  // namespace

Differences CompareArtefacts(const std::filesystem::path& one, const std::filesystem::path& two,
                             double tolerance) {
  const json header_one = ReadArtefactHeader(one);
  const json header_two = ReadArtefactHeader(two);
  if (header_one.at("kind") != header_two.at("kind")) {
    throw InputError(fmt::format("{}: artefact kind is {}, that of {} is {}; expected one kind",
                                 one.string(), header_one["kind"].dump(), two.string(),
                                 header_two["kind"].dump()));
  }
  Differences differences{header_one["kind"], {}, {}};
  constexpr double kExactly = 0.0;
  Comparison(kExactly, &differences.provenance)
      .Compare(header_one, header_two, json::json_pointer("/artefact"));
  Comparison content(tolerance, &differences.content);
  if (IsHdf5(one) && IsHdf5(two)) {
    const Hdf5File file_one = OpenArtefact(one, differences.kind);
    const Hdf5File file_two = OpenArtefact(two, differences.kind);
    file_one.RequireWalkable();
    file_two.RequireWalkable();
    content.CompareGroup(file_one, file_two, "/");
  } else {
    json document_one = ReadArtefact(one, differences.kind);
    json document_two = ReadArtefact(two, differences.kind);
    document_one.erase("artefact");
    document_two.erase("artefact");
    content.Compare(document_one, document_two, json::json_pointer());
  }
  return differences;
}

std::string FormatDifferences(const Differences& differences, double tolerance, bool is_coloured) {
  std::string text;
  if (!differences.provenance.empty()) {
    text += fmt::format("provenance differs, places: {}\n{}\n", differences.provenance.size(),
                        FormatPlaces(differences.provenance, is_coloured));
  }
  if (differences.content.empty()) {
    return text +
           fmt::format("content of kind '{}' is equal within {:g}\n", differences.kind, tolerance);
  }
  return text + fmt::format("content of kind '{}' differs by more than {:g}, places: {}\n{}",
                            differences.kind, tolerance, differences.content.size(),
                            FormatPlaces(differences.content, is_coloured));
}

}  // namespace soslam
