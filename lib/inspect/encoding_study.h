// What other encodings of a signal would cost and give: the experiments of [Sloan03] §4 and §5.
#pragma once

#include <cstdint>
#include <vector>

#include "cpca/encoding.h"
#include "inspect/error_figure.h"
#include "inspect/line_plot.h"
#include "signal/transfer_signal.h"

namespace prt::inspect {

/// [Sloan03] Figure 2: squared error over storage m_p n' + m_c (n' + 1) n of static CPCA, a curve
/// for each n' of 0, 1, 2, 4, 8, 16, along numbers of clusters 1, 4, 16, … up to 1,024 and to a
/// thirty-second of the points.
LinePlot error_over_storage(const signal::TransferSignal& signal);

/// [Sloan03] Figure 3: squared error over n' = 0 … `most_components`, a curve for each method; the
/// adaptive one, which has to be encoded for each n', at 0, 1, 2, 4, 8 … and the last. Its
/// encodings begin with the clusters of the iterative one.
LinePlot error_over_components(const signal::TransferSignal& signal, int cluster_count,
                               int most_components);

/// An iterative encoding as those that follow take it.
cpca::Encoding encode_iteratively(const signal::TransferSignal& signal, int cluster_count,
                                  int component_count);

/// [Sloan03] Figure 4: errors of static and adaptive encodings with as many clusters and vectors as
/// an iterative one, and of that, in the order of the paper.
std::vector<EncodingError> errors_by_method(const signal::TransferSignal& signal,
                                            const cpca::Encoding& iterative);

/// How long these take in proportion, about: encode_iteratively, errors_by_method,
/// error_over_storage and error_over_components, for a signal of so many points and the counts that
/// they are given.
struct StudyWork {
  double iterative = 0.0, methods = 0.0, storage = 0.0, components = 0.0;
};
StudyWork study_work(std::size_t point_count, int cluster_count, int component_count,
                     int most_components);

/// Of an encoding, as CompressionError has them.
EncodingError error_of(const std::string& name, const cpca::Encoding& encoding,
                       const signal::TransferSignal& signal);

/// [Sloan03] Figure 5: an encoding of the signal before and after coherence optimisation with the
/// usual budgets.
struct CoherenceStudy {
  std::vector<std::uint32_t> before, reclassified;  ///< cluster of each point, numbered alike
  std::vector<std::uint32_t> superclustered;        ///< supercluster of each point
};
CoherenceStudy study_coherence(const signal::TransferSignal& signal,
                               const std::vector<std::uint32_t>& indices, cpca::Encoding encoding);

}  // namespace prt::inspect
