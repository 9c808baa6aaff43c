#include "cpca/search_model.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace prt::cpca {

namespace {

/// Exponents that occur, and that of one column alone. Errors below the least count as that.
constexpr double kSteepest = -2.0, kFlattest = -0.02, kUsual = -0.5, kLeastLogged = 1e-12;

/// Of logarithms of errors: more than that is luck.
constexpr double kMostShift = 1.5;

double log_of(double error) { return std::log(std::max(error, kLeastLogged)); }

/// The fewest clusters of an error, if any do.
std::optional<int> fewest_clusters(const ErrorModel& model, int component_count, double max_error,
                                   int most) {
  const auto is_within = [&](int clusters) {
    return model.error({clusters, component_count}) <= max_error;
  };
  if (!is_within(most)) return std::nullopt;
  int too_few = 0, enough = most;
  while (enough - too_few > 1) {
    const int middle = too_few + (enough - too_few) / 2;
    (is_within(middle) ? enough : too_few) = middle;
  }
  return enough;
}

/// The most clusters within the bytes of the aim, 0 when none are as small.
int most_clusters_within(const Bound& aim, const Size& size, int component_count, int most) {
  const std::size_t max_bytes = aim.most_bytes(size);
  const auto bytes = [&](int clusters) {
    return aim.cost.bytes(size, {clusters, component_count});
  };
  if (bytes(1) > max_bytes) return 0;
  const std::size_t fit = 1 + (max_bytes - bytes(1)) / (bytes(2) - bytes(1));
  return static_cast<int>(std::min<std::size_t>(fit, static_cast<std::size_t>(most)));
}

}  // namespace

void ErrorModel::add(const Column& column) {
  const auto place = std::find_if(columns_.begin(), columns_.end(), [&](const Column& other) {
    return other.cluster_count >= column.cluster_count;
  });
  Column logs = column;
  for (double& error : logs.errors) error = log_of(error);
  const bool is_known = place != columns_.end() && place->cluster_count == column.cluster_count;
  if (is_known) {
    *place = std::move(logs);
  } else {
    columns_.insert(place, std::move(logs));
  }
}

int ErrorModel::most_components() const {
  std::size_t most = 0;
  for (const Column& column : columns_) most = std::max(most, column.errors.size() - 1);
  return static_cast<int>(most);
}

/// Beyond its end a column goes on like the nearest one that is longer, or straight on.
double ErrorModel::column_value(std::size_t column, std::size_t components) const {
  const std::vector<double>& own = columns_[column].errors;
  if (components < own.size()) return own[components];
  for (std::size_t step = 1; step < columns_.size(); ++step) {
    for (const std::size_t other : {column - step, column + step}) {  // wrapped ones are too great
      if (other >= columns_.size() || columns_[other].errors.size() <= components) continue;
      const std::vector<double>& longer = columns_[other].errors;
      return own.back() + longer[components] - longer[own.size() - 1];
    }
  }
  if (own.size() == 1) return own.back();
  const double step = std::min(0.0, own.back() - own[own.size() - 2]);
  return own.back() + step * static_cast<double>(components + 1 - own.size());
}

double ErrorModel::log_error(const Choice& choice) const {
  const auto components = static_cast<std::size_t>(choice.component_count);
  // Other clusters tell nothing of one.
  if (is_one(choice)) return column_value(0, components) + one_shift_;
  const double x = std::log(choice.cluster_count);
  const double shift = shifts_.empty() ? 0.0 : shifts_[std::min(components, shifts_.size() - 1)];
  const auto at = [&](std::size_t c) { return std::log(columns_[c].cluster_count); };
  if (columns_.size() == 1) return column_value(0, components) + kUsual * (x - at(0)) + shift;
  std::size_t c = 0;  // the stretch that it lies in, or the next one
  while (c + 2 < columns_.size() && x > at(c + 1)) ++c;
  const double low = column_value(c, components), high = column_value(c + 1, components);
  const double slope = std::clamp((high - low) / (at(c + 1) - at(c)), kSteepest, kFlattest);
  // What steeper falls do between their ends is not known.
  return (x < at(c + 1) ? low + slope * (x - at(c)) : high + slope * (x - at(c + 1))) + shift;
}

double ErrorModel::error(const Choice& choice) const { return std::exp(log_error(choice)); }

bool ErrorModel::is_one(const Choice& choice) const {
  return choice.cluster_count == 1 && columns_[0].cluster_count == 1;
}

void ErrorModel::correct(const Column& measured) {
  const Choice last{measured.cluster_count, static_cast<int>(measured.errors.size()) - 1};
  if (is_one(last)) return replace_one(measured);
  shifts_.clear();
  std::vector<double> shifts;
  for (std::size_t i = 0; i < measured.errors.size(); ++i) {
    shifts.push_back(log_of(measured.errors[i]) -
                     log_error({measured.cluster_count, static_cast<int>(i)}));
  }
  shifts.push_back(std::abs(shifts.back()) > kMostShift ? 0.0 : shifts.back());  // of the rest
  shifts_ = std::move(shifts);
}

/// Others go on like it beyond their ends.
void ErrorModel::replace_one(const Column& measured) {
  std::vector<double>& logs = columns_[0].errors;
  const std::size_t count = std::min(measured.errors.size(), logs.size());
  const double shift = log_of(measured.errors[count - 1]) - logs[count - 1];
  for (std::size_t i = 0; i < logs.size(); ++i) {
    logs[i] = i < count ? log_of(measured.errors[i]) : logs[i] + shift;
  }
  for (std::size_t i = count; i < measured.errors.size(); ++i) {
    logs.push_back(log_of(measured.errors[i]));
  }
  one_shift_ = 0.0;
}

void ErrorModel::correct(const Choice& choice, double error) {
  if (shifts_.empty()) shifts_.assign(1, 0.0);
  const double shift = log_of(error) - log_error(choice);
  // That all was exact there, by luck, tells nothing of others.
  if (is_one(choice) || std::abs(shift) > kMostShift) return correct_alone(choice, error);
  for (double& known : shifts_) known += shift;
}

void ErrorModel::correct_alone(const Choice& choice, double error) {
  if (is_one(choice)) {
    one_shift_ += log_of(error) - log_error(choice);
    return;
  }
  const auto count = static_cast<std::size_t>(choice.component_count) + 1;
  if (shifts_.empty()) shifts_.assign(1, 0.0);
  while (shifts_.size() <= count) shifts_.push_back(shifts_.back());
  shifts_[count - 1] += log_of(error) - log_error(choice);
}

Choice choose(const ErrorModel& model, const Bound& aim, const Size& size, int most_clusters) {
  aim.check_room(size);
  const int most_components =
      std::min(aim.cost.whole(size).component_count, model.most_components() + 2);
  struct Rated {
    Choice choice;
    double worth, next;  // less is better
  };
  std::optional<Rated> best, closest;
  const auto take = [](std::optional<Rated>& to, const Rated& rated) {
    const bool is_better =
        !to || (rated.worth != to->worth ? rated.worth < to->worth : rated.next < to->next);
    if (is_better) to = rated;
  };
  const auto rate_error = [&](const Choice& choice) {
    return Rated{choice, model.error(choice), static_cast<double>(aim.cost.bytes(size, choice))};
  };
  for (int i = 0; i <= most_components; ++i) {
    const int most = most_clusters_within(aim, size, i, most_clusters);
    if (most == 0) break;
    take(closest, rate_error({most, i}));
    if (const auto fewest = fewest_clusters(model, i, aim.max_error.value_or(kExact), most)) {
      const Rated rated = rate_error({*fewest, i});
      take(best, {rated.choice, rated.next, rated.worth});
    }
  }
  return best ? best->choice : closest->choice;
}

std::optional<Choice> choose_most(const Bound& aim, const Size& size, int most_clusters,
                                  int component_count) {
  if (component_count < 0 || component_count > aim.cost.whole(size).component_count) {
    return std::nullopt;
  }
  const int most = most_clusters_within(aim, size, component_count, most_clusters);
  return most > 0 ? std::optional(Choice{most, component_count}) : std::nullopt;
}

std::optional<Choice> choose_clusters(const ErrorModel& model, const Bound& aim, const Size& size,
                                      int most_clusters, int component_count) {
  const auto most = choose_most(aim, size, most_clusters, component_count);
  if (!most) return std::nullopt;
  const auto fewest = fewest_clusters(model, component_count, *aim.max_error, most->cluster_count);
  return fewest ? std::optional(Choice{*fewest, component_count}) : std::nullopt;
}

}  // namespace prt::cpca
