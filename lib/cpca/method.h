// The encoders by name, for callers that are told which one to take.
#pragma once

#include "cpca/encoder.h"

namespace prt::cpca {

enum class Method { fixed, iterative, adaptive };  ///< encode_static, encode_iterative, …

inline Encoded encode(Method method, std::span<const float> signal, int dimension,
                      const Options& options) {
  return method == Method::adaptive    ? encode_adaptive(signal, dimension, options)
         : method == Method::iterative ? encode_iterative(signal, dimension, options)
                                       : encode_static(signal, dimension, options);
}

}  // namespace prt::cpca
