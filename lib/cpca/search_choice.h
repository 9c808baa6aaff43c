// What a search chooses between, and what it is worth: numbers of clusters and of vectors, their
// bytes and errors.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cpca/encoding.h"

namespace prt::cpca {

struct Choice {
  int cluster_count = 0, component_count = 0;

  bool operator==(const Choice&) const = default;
};

/// Of a signal.
struct Size {
  std::size_t point_count = 0, dimension = 0;
};

/// How an encoding will be stored, beside its means and vectors, which are floats. To begin with,
/// as storage_bytes counts.
struct StorageCost {
  std::size_t bytes_of_headers = 0;
  std::size_t bytes_per_point = 2;  ///< its cluster, one of 65536 at most
  std::size_t bytes_per_weight = 4;
  std::size_t weight_group = 1;       ///< weights of a point are padded to a multiple of this
  std::size_t bytes_per_cluster = 0;  ///< beside its mean and vectors
  int max_component_count = 256;

  /// Of an encoding in which every cluster has as many vectors.
  std::size_t bytes(const Size& size, const Choice& choice) const;
  std::size_t bytes(const Encoding& encoding) const;

  /// One cluster with all vectors, which is exact, or as many as there can be.
  Choice whole(const Size& size) const;

  /// As many hold a signal exactly: as it is, or that cluster, which of few points is more.
  std::size_t enough_bytes(const Size& size) const;
};

enum class Norm {
  rmse,    ///< root of the squared error over the energy of the signal
  maximum  ///< root of the largest squared error of a point over the mean energy of a point
};

/// Exactly one of max_error and max_bytes.
struct Bound {
  std::optional<double> max_error;  ///< > 0, relative
  Norm norm = Norm::rmse;
  std::optional<std::size_t> max_bytes;  ///< of what `cost` says
  StorageCost cost = {};

  /// Largest errors of points are what encodings are tightened to.
  bool is_tight() const { return max_error && norm == Norm::maximum; }

  /// max_bytes, as far as these are of use, or twice what holds the signal, as what a few points
  /// need may exceed it once.
  std::size_t most_bytes(const Size& size) const;
  /// Throws Error (failed) when not even one cluster without vectors is as small.
  void check_room(const Size& size) const;
};

/// Error of an encoding by a norm; squares of points, of errors and energies alike, are multiplied
/// with `point_weights` (empty: 1). 0 for a signal without energy.
double relative_error(const Encoding& encoding, std::span<const float> signal, Norm norm,
                      std::span<const float> point_weights = {});

/// The same of an error by the norm: the sum over points, or the largest of one.
double relative(double error, Norm norm, std::size_t point_count, double energy);

/// Errors by the norm if clusters had only their first 0, 1, … vectors, up to all; these are
/// orthonormal.
std::vector<double> combined_errors(const Encoding& encoding, std::span<const float> signal,
                                    Norm norm, std::span<const float> point_weights = {});
/// Relative ones.
std::vector<double> relative_errors(const Encoding& encoding, std::span<const float> signal,
                                    Norm norm, std::span<const float> point_weights = {});

/// Σ_p weight_p ‖x_p‖².
double weighted_energy(std::span<const float> signal, std::size_t point_count,
                       std::span<const float> point_weights);

}  // namespace prt::cpca
