#include "compress/format_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <tuple>

#include "compress/arrays.h"
#include "core/error.h"
#include "core/log.h"
#include "cpca/fit.h"
#include "gltf/precomputed_transfer.h"

namespace prt::compress {

namespace {

using cpca::WeightFormat;

/// Rounding may take less than that share of max_error²: beyond, finer weights take less room.
constexpr double kMostReserve = 0.5;
/// Of relative errors: finer weights are of no use.
constexpr double kNoRounding = 1e-4;
/// Errors are measured again in the signal's own coordinates, which rounds differently.
constexpr double kMargin = 1e-5;
/// Seconds: how a shorter search compares with an encoding is of no interest.
constexpr double kNoticed = 1.0;

/// As gltf::stored_bytes counts.
cpca::StorageCost cost_in_model(const Job& job, WeightFormat format) {
  return {.bytes_per_point = 4,
          .bytes_per_weight = cpca::bytes_of(format),
          .weight_group = job.method == "adaptive" ? 1u : 4u,
          .bytes_per_cluster = 2 * sizeof(std::uint16_t),
          .max_component_count = gltf::kMaxComponentCount};
}

cpca::StorageCost cost_of(const Job& job, WeightFormat format) {
  cpca::StorageCost cost = job.signal.empty() ? cost_in_model(job, format) : cost_in_arrays();
  if (job.max_component_count > 0) cost.max_component_count = job.max_component_count;
  if (job.method == "vq") cost.max_component_count = 0;
  return cost;
}

/// Share of the bytes that weights take.
double weight_share(cpca::StorageCost cost, const cpca::Encoding& encoding) {
  const auto bytes = static_cast<double>(cost.bytes(encoding));
  cost.bytes_per_weight = 0;
  return 1.0 - static_cast<double>(cost.bytes(encoding)) / bytes;
}

class FormatSearch {
 public:
  FormatSearch(const Job& job, const Input& input, const cpca::Options& options, Report& report)
      : job_(job),
        input_(input),
        json_(report.json()),
        search_(method_of(job), input.transfer.values, static_cast<int>(input.dimension), options) {
    json_["search_cost"] = 0.0;
    json_["search"] = {{"sampled_points", 0},
                       {"seconds", 0.0},
                       {"flops_cost", 0.0},
                       {"trials", nlohmann::ordered_json::array()}};
  }

  Result run() {
    std::exception_ptr failure;
    for (const WeightFormat format : formats()) {
      std::optional<Candidate> candidate;
      // What is out of reach is so with finer weights too, but for what rounding took.
      if (failure && job_.bound.max_error && format != WeightFormat::float32) continue;
      if (best_ && !is_lucky() && !search_.can_afford(best_->found)) break;
      try {
        candidate = search(format);
      } catch (const Error&) {  // another format may still do
        failure = std::current_exception();
      }
      if (!candidate) continue;
      const bool is_fine = candidate->is_fine;
      if (!best_ ||
          std::tie(candidate->worth, candidate->next) < std::tie(best_->worth, best_->next))
        best_ = std::move(candidate);
      if (is_fine && !(is_lucky() && format == WeightFormat::unorm8)) break;
    }
    if (!best_ && !std::isfinite(least_error_)) std::rethrow_exception(failure);
    if (!best_) reject_rounding();
    cpca::Found& found = best_->found;
    search_.add_up(found);
    tell(found);
    best_->result.encoded = std::move(found.encoded);
    cpca::fit_weights(input_.transfer.values, best_->result.encoded.encoding);
    return std::move(best_->result);
  }

 private:
  struct Candidate {
    cpca::Found found;
    Result result = {};              ///< without the encoding
    double worth = 0.0, next = 0.0;  ///< less is better
    bool is_fine = false;            ///< finer weights are not worth their bytes
  };

  /// In as many bytes static encodings of as fine weights differ by luck: one more is taken.
  bool is_lucky() const { return job_.method == "static" && job_.bound.max_bytes; }

  /// The smallest first.
  std::vector<WeightFormat> formats() const {
    const bool has_weights = cost_of(job_, WeightFormat::float32).max_component_count > 0;
    if (!input_.document || !has_weights) return {WeightFormat::float32};
    if (job_.storage.weights) return {*job_.storage.weights};
    return {WeightFormat::unorm8, WeightFormat::unorm16, WeightFormat::float16,
            WeightFormat::float32};
  }

  [[noreturn]] void reject_rounding() const {
    const bool is_given = job_.storage.weights.has_value();
    throw_failed(is_given ? "weights as small as --weights asks for are not within --max-error"
                          : "no encoding found within --max-error whose weights are rounded",
                 {.found = fmt::format("a relative error of {:.6g}", least_error_),
                  .expected = fmt::format("at most {:.6g}", *job_.bound.max_error),
                  .advice = is_given ? "Take --weights auto." : ""});
  }

  cpca::Bound bound(WeightFormat format, double reserve) const {
    cpca::Bound bound = job_.bound;
    bound.cost = cost_of(job_, format);
    if (bound.max_error) {
      *bound.max_error *= std::sqrt((1.0 - reserve) / (1.0 + reclassification_share(job_)));
    }
    return bound;
  }

  /// Nothing when rounding takes too much of the bound.
  std::optional<Candidate> search(WeightFormat format) {
    double reserve = format == WeightFormat::float32 ? 4.0 * kMargin : cpca::kMaxAddedError;
    while (reserve < kMostReserve) {
      const cpca::Bound bound = this->bound(format, reserve);
      Candidate candidate{.found = find(bound, format)};
      candidate.result.reserve = reserve;
      cpca::Encoding& encoding = candidate.found.encoded.encoding;
      if (input_.document) candidate.result.weights = format;
      const double exact = error(encoding);
      encoding.weights = std::vector<float>();  // they follow from the rest
      cpca::Encoding stored = encoding;
      cpca::fit_weights(input_.transfer.values, stored);
      cpca::convert_weights(format, stored);
      const double rounded = error(stored);
      const double added = std::max(0.0, rounded * rounded - exact * exact);
      if (is_within(job_, format, stored, input_)) {
        const auto bytes = static_cast<double>(bound.cost.bytes(encoding));
        candidate.worth = job_.bound.max_error ? bytes : rounded;
        candidate.next = job_.bound.max_error ? rounded : bytes;
        // Half floats take no more room than integers.
        const double gain =
            format == WeightFormat::unorm16 ? 0.0 : 0.5 * weight_share(bound.cost, encoding);
        const double whole = job_.bound.max_error.value_or(rounded);
        candidate.is_fine = added <= std::max(cpca::kMaxAddedError, gain) * whole * whole ||
                            (job_.bound.max_bytes && added <= kNoRounding * kNoRounding);
        return candidate;
      }
      if (!job_.bound.max_error) {
        throw_failed("no encoding found that is as small",
                     {.expected = fmt::format("at most {} bytes", *job_.bound.max_bytes)});
      }
      least_error_ = std::min(least_error_, rounded);
      const double share = added / (*job_.bound.max_error * *job_.bound.max_error);
      reserve = std::max(2.0 * reserve, 1.1 * share);
    }
    return std::nullopt;
  }

  double error(const cpca::Encoding& encoding) const {
    return cpca::relative_error(encoding, input_.transfer.values, job_.bound.norm,
                                input_.point_weights);
  }

  /// Tells what is out of reach by the bound of the job, which is the user's.
  cpca::Found find(const cpca::Bound& bound, double budget) {
    try {
      return search_.find(bound, budget);
    } catch (const Error& error) {
      if (!bound.max_error) throw;
      const std::string asked = fmt::format("{:.4g}", *job_.bound.max_error),
                        searched = fmt::format("{:.4g}", *bound.max_error);
      throw_failed(
          "no encoding found within --max-error",
          {.found = error.details().found,
           .expected = "at most " + asked +
                       (searched == asked ? "" : " as stored, " + searched + " as encoded"),
           .advice = "Allow some more."});
    }
  }

  cpca::Found find(const cpca::Bound& bound, WeightFormat format) {
    const bool is_first = is_lucky() && format == WeightFormat::unorm8 && !job_.storage.weights;
    const double left = is_first ? 1.0 : 0.0;  // an encoding for the other format
    cpca::Found found = find(bound, cpca::kBudget - left);
    for (const cpca::Trial& trial : found.trials) {
      nlohmann::ordered_json row = {{"first_cluster_count", trial.first_cluster_count},
                                    {"cluster_count", trial.choice.cluster_count},
                                    {"component_count", trial.choice.component_count},
                                    {"relative_error", trial.error},
                                    {"bytes", trial.bytes},
                                    {"warm", trial.is_warm},
                                    {"resumed", trial.is_resumed},
                                    {"seconds", trial.seconds}};
      if (input_.document) row["weights"] = cpca::name_of(format);
      json_["search"]["trials"].push_back(row);
    }
    return found;
  }

  void tell(const cpca::Found& found) const {
    json_["search"]["sampled_points"] = found.sampled_count;
    json_["search"]["seconds"] = found.seconds;
    json_["search"]["flops_cost"] = found.flops_cost();
    json_["search_cost"] = found.cost();
    if (found.seconds < kNoticed) return;
    log::info("the search took as long as {:.2f} encodings of what it kept", found.cost());
  }

  const Job& job_;
  const Input& input_;
  nlohmann::ordered_json& json_;
  cpca::Search search_;
  std::optional<Candidate> best_;
  /// Of those that weights as they are stored took beyond max_error.
  double least_error_ = std::numeric_limits<double>::infinity();
};

/// Once, for weights as small as they may be.
void warn_of_useless_bytes(const Job& job, const Input& input) {
  const WeightFormat format = job.storage.weights.value_or(WeightFormat::float32);
  const std::size_t enough =
      cost_of(job, format)
          .enough_bytes({input.transfer.values.size() / input.dimension, input.dimension});
  if (job.bound.max_bytes.value_or(0) <= enough) return;
  log::warning(
      "--max-bytes is more than any use: {} bytes hold the signal as it is, no more are taken",
      enough);
}

}  // namespace

cpca::Method method_of(const Job& job) {
  return job.method == "adaptive"    ? cpca::Method::adaptive
         : job.method == "iterative" ? cpca::Method::iterative
                                     : cpca::Method::fixed;
}

double reclassification_share(const Job& job) {
  // Of the largest error of a point it takes only what is left.
  const bool spends = job.signal.empty() && !job.storage.is_incoherent && job.bound.max_error &&
                      job.bound.norm == cpca::Norm::rmse;
  return spends ? job.storage.coherence.error_budget : 0.0;
}

bool is_within(const Job& job, WeightFormat format, const cpca::Encoding& stored,
               const Input& input) {
  if (job.bound.max_bytes) return cost_of(job, format).bytes(stored) <= *job.bound.max_bytes;
  return cpca::relative_error(stored, input.transfer.values, job.bound.norm, input.point_weights) <=
         (1.0 - kMargin) * *job.bound.max_error;
}

Result search(const Job& job, const Input& input, const cpca::Options& options, Report& report) {
  warn_of_useless_bytes(job, input);
  return FormatSearch(job, input, options, report).run();
}

}  // namespace prt::compress
