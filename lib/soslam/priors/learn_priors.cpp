// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/priors/learn_priors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "soslam/evaluation/statistics.h"
#include "soslam/model/label_groups.h"

namespace soslam {
namespace {

// The logarithms that are learned for a label.
enum LearnedQuantity { kDepthRatio, kWidthRatio, kHeight, kNumQuantities };

// All data for a row.
struct RowData {
  std::array<std::vector<double>, kNumQuantities> logs;
  std::vector<ShapeExponents> shape_exponents;
  std::vector<std::string> cited;  // "3 of room_a"

  size_t Count() const { return logs[kHeight].size(); }
  std::optional<double> Correlation() const {
    return RobustCorrelation(logs[kDepthRatio], logs[kWidthRatio]);
  }
};

// Statistics pooled over labels.
struct Pooled {
  std::array<double, kNumQuantities> log_sigma{};
  double correlation = 0.0;
};

constexpr double kTypicalLogSigma = 0.3;  // if no label has enough objects
constexpr size_t kMinPooled = 5;          // minimal number of objects for a label to be pooled
constexpr double kMaxCorrelation = 0.95;

double Rounded(double value) { return std::round(value * 1e4) / 1e4; }

// Means over the labels with enough objects, weighted with their degrees of freedom.
Pooled Pool(const std::map<std::string, RowData>& data, double min_sigma) {
  std::array<double, kNumQuantities> squares{};
  double freedom = 0.0;
  double correlation = 0.0;
  double correlated = 0.0;
  for (const auto& [label, row] : data) {
    if (row.Count() < kMinPooled) continue;
    const auto weight = static_cast<double>(row.Count() - 1);
    freedom += weight;
    for (size_t k = 0; k < kNumQuantities; ++k) {
      const double sigma = std::max(min_sigma, RobustSigma(row.logs[k]));
      squares[k] += weight * sigma * sigma;
    }
    if (const auto of_label = row.Correlation()) {
      correlation += weight * *of_label;
      correlated += weight;
    }
  }
  Pooled pooled;
  for (size_t k = 0; k < kNumQuantities; ++k) {
    pooled.log_sigma[k] = freedom > 0.0 ? std::sqrt(squares[k] / freedom) : kTypicalLogSigma;
  }
  if (correlated > 0.0) pooled.correlation = correlation / correlated;
  return pooled;
}

// Learns the rows of one table.
class Learner {
 public:
  Learner(const Pooled& pooled, const LearnPriorsOptions& options)
      : pooled_(pooled), options_(options) {}

  // Updates a row of the base table, or learns a new one that has no more than a label and a shape.
  SemanticRow Learned(const SemanticRow& base, const RowData& data, bool is_new) const {
    const bool update = is_new || options_.base_rows == BaseRows::kUpdate;
    const auto known = [&](double median, double log_sigma) {
      const double objects = std::max(1, base.samples);
      return NormalBelief{std::log(median), objects, log_sigma, options_.spread_weight};
    };
    SemanticRow row = base;
    if (update) {
      for (int k = 0; k < 2; ++k) {
        Learn(data.logs[k],
              is_new ? Unknown(k) : known(base.prior.ratio[k], base.prior.log_sigma[k]),
              &row.prior.ratio[k], &row.prior.log_sigma[k]);
      }
      row.samples += static_cast<int>(data.Count());
      const auto mean = [&](double ShapeExponents::*exponent) {
        return Rounded(*MeanOf(CollectValues(data.shape_exponents, exponent)));
      };
      if (!data.shape_exponents.empty()) {
        row.prior.shape_exponents = {mean(&ShapeExponents::horizontal),
                                     mean(&ShapeExponents::vertical)};
      }
    }
    const auto& height = base.prior.height_m;
    if (!height) {
      LearnHeight(data, Unknown(kHeight), &row.prior);
    } else if (update) {
      LearnHeight(data, known(height->median, height->log_sigma), &row.prior);
    }
    LearnCorrelation(data, &row.prior);
    const bool is_kept = !update && height && base.prior.log_correlation != 0.0;
    if (data.Count() > 0 && !is_kept) {
      const char* how = update ? "; updated by: " : "; size, correlation: ";
      row.source +=
          (is_new ? "learned from " : how) + fmt::format("{}", fmt::join(data.cited, ", "));
    }
    return row;
  }

  void LearnCorrelation(const RowData& data, ShapePrior* prior) const {
    if (prior->log_correlation != 0.0 && options_.base_rows == BaseRows::kKeep) return;
    double correlation =
        prior->log_correlation != 0.0 ? prior->log_correlation : pooled_.correlation;
    if (const auto of_label = data.Correlation()) {
      const auto objects = static_cast<double>(data.Count());
      correlation = (options_.correlation_weight * correlation + objects * *of_label) /
                    (options_.correlation_weight + objects);
    }
    prior->log_correlation = Rounded(std::clamp(correlation, -kMaxCorrelation, kMaxCorrelation));
  }

 private:
  NormalBelief Unknown(size_t quantity) const {
    return {0.0, 0.0, pooled_.log_sigma[quantity], options_.spread_weight};
  }

  void Learn(const std::vector<double>& logs, const NormalBelief& prior, double* median,
             double* log_sigma) const {
    if (logs.empty()) return;
    const NormalBelief belief = Update(prior, logs, options_.min_log_sigma);
    *median = Rounded(std::exp(belief.mean));
    *log_sigma = Rounded(PredictiveSigma(belief));
  }

  void LearnHeight(const RowData& data, const NormalBelief& belief, ShapePrior* prior) const {
    if (data.Count() == 0) return;
    LogNormal height{};
    Learn(data.logs[kHeight], belief, &height.median, &height.log_sigma);
    prior->height_m = height;
  }

  Pooled pooled_;
  LearnPriorsOptions options_;
};

// The true half axes of an object that stands upright, as catalogues and tables have them.
Eigen::Vector3d TrueHalfAxes(const Object& object, const SemanticTable& table) {
  Eigen::Vector3d half_axes = InOwnAxes(object.ground_truth->landmark_in_world).half_axes;
  const bool is_on_wall = table.Find(object.label).value_or(ShapePrior()).mount == Mount::kOnWall;
  if (is_on_wall) std::swap(half_axes.x(), half_axes.z());
  return half_axes;
}

}  // namespace

PriorSource SourceOfSequence(const Sequence& sequence, const SemanticTable& table, int min_views) {
  PriorSource source{sequence.name, {}};
  const std::map<int, ShapeExponents> exponents = LearnShapeExponents(sequence, min_views);
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    const Object& object = sequence.objects[i];
    if (!object.ground_truth) continue;
    LabelFacts& facts = source.facts[object.label];
    facts.half_axes.push_back(TrueHalfAxes(object, table));
    const auto exponent = exponents.find(static_cast<int>(i));
    if (exponent != exponents.end()) facts.shape_exponents.push_back(exponent->second);
  }
  return source;
}

PriorSource SourceOfCatalogue(const std::string& name, const std::vector<CatalogueModel>& models,
                              const CatalogueNames& names) {
  PriorSource source{name, {}};
  for (const auto& [label, names_of_label] : names) {
    for (const CatalogueModel& model : models) {
      if (GoesBy(model, names_of_label)) source.facts[label].half_axes.push_back(model.half_axes);
    }
  }
  return source;
}

std::vector<CatalogueModel> ExcludeObjects(const Sequence& sequence, const SemanticTable& table,
                                           std::vector<CatalogueModel> models) {
  constexpr double kSameHalfAxisM = 0.5e-3 + 1e-9;
  std::vector<Eigen::Vector3d> in_scene;
  for (const Object& object : sequence.objects) {
    if (object.ground_truth) in_scene.push_back(TrueHalfAxes(object, table));
  }
  const auto is_object = [&](const CatalogueModel& model) {
    return std::ranges::any_of(in_scene, [&](const Eigen::Vector3d& half_axes) {
      return (half_axes - model.half_axes).cwiseAbs().maxCoeff() <= kSameHalfAxisM;
    });
  };
  std::erase_if(models, is_object);
  return models;
}

SemanticRows LearnPriors(const SemanticRows& base, const std::vector<PriorSource>& sources,
                         const LearnPriorsOptions& options) {
  std::map<std::string, std::string> label_of;  // by normalised name
  for (const auto& [name, row] : RowsByName(base)) label_of[name] = base.rows[row].label;
  // Data by label of the row; labels that are aliases contribute to their row.
  std::map<std::string, RowData> data;
  for (const PriorSource& source : sources) {
    for (const auto& [label, facts] : source.facts) {
      if (facts.half_axes.empty()) continue;
      RowData& row = data[label_of.emplace(NormalisedLabel(label), label).first->second];
      for (const Eigen::Vector3d& half_axes : facts.half_axes) {
        row.logs[kDepthRatio].push_back(std::log(half_axes.x() / half_axes.z()));
        row.logs[kWidthRatio].push_back(std::log(half_axes.y() / half_axes.z()));
        row.logs[kHeight].push_back(std::log(2.0 * half_axes.z()));
      }
      row.shape_exponents.insert(row.shape_exponents.end(), facts.shape_exponents.begin(),
                                 facts.shape_exponents.end());
      row.cited.push_back(fmt::format("{} of {}", facts.half_axes.size(), source.name));
    }
  }
  const Learner learner(Pool(data, options.min_log_sigma), options);
  SemanticRows learned{base.description, base.default_row, {}};
  if (learned.default_row) learner.LearnCorrelation({}, &learned.default_row->prior);
  for (const SemanticRow& row : base.rows) {
    learned.rows.push_back(learner.Learned(row, data[row.label], /*is_new=*/false));
    data.erase(row.label);
  }
  SemanticRow new_row;
  if (base.default_row) new_row.prior.shape_exponents = base.default_row->prior.shape_exponents;
  for (const auto& [label, of_label] : data) {
    new_row.label = label;
    learned.rows.push_back(learner.Learned(new_row, of_label, /*is_new=*/true));
  }
  std::ranges::sort(learned.rows, {}, &SemanticRow::label);
  LookUpTable(learned);  // throws if names are not unique
  return learned;
}

std::vector<PriorError> PriorErrors(const Sequence& sequence, const SemanticTable& table) {
  std::vector<PriorError> errors;
  for (const Object& object : sequence.objects) {
    std::optional<ShapePrior> prior = table.Find(object.label);
    if (!object.ground_truth || !prior) continue;
    prior = TurnedToSupport(*prior);
    const Eigen::Vector3d half_axes = InOwnAxes(object.ground_truth->landmark_in_world).half_axes;
    PriorError error{object.label, {}, {}};
    error.log_error =
        (half_axes.head<2>().array() / half_axes.z() / prior->ratio.array()).log().matrix();
    error.normalised = error.log_error.cwiseQuotient(prior->log_sigma);
    errors.push_back(error);
  }
  return errors;
}

}  // namespace soslam
