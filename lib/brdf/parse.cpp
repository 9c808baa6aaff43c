#include <charconv>

#include "brdf/brdf.h"
#include "core/error.h"

namespace prt::brdf {

namespace {

constexpr double kMaxExponent = 1e6;

[[noreturn]] void reject(std::string_view text) {
  throw Error(ErrorKind::usage, "not a BRDF",
              {.found = std::string(text),
               .expected = std::string(kBrdfSyntax),
               .advice = "ALPHA is in [0.001, 1], N is in [1, 1e6], N_U and N_V are in [0, 1e6], "
                         "RS is in [0, 1]."});
}

struct Parser {
  std::string_view text, name;
  std::vector<double> numbers{};

  void read_numbers(std::string_view list) {
    const char *at = list.data(), *end = list.data() + list.size();
    while (true) {
      double value = 0;
      const auto [next, status] = std::from_chars(at, end, value);
      if (status != std::errc{}) reject(text);
      numbers.push_back(value);
      if (next == end) return;
      if (*next != ',') reject(text);
      at = next + 1;
    }
  }

  /// Number `i`, between limits; from_chars also reads nan and inf.
  double number(std::size_t i, double low, double high) const {
    if (!(numbers[i] >= low && numbers[i] <= high)) reject(text);
    return numbers[i];
  }

  bool is(std::string_view model, std::size_t min_count, std::size_t max_count) const {
    return name == model && numbers.size() >= min_count && numbers.size() <= max_count;
  }
};

Brdf white(LobePointer lobe) { return {{{Colour(1), std::move(lobe)}}}; }

Brdf make_ashikhmin_shirley(double n_u, double n_v, double rs) {
  if (rs == 1) return white(ashikhmin_shirley(n_u, n_v));
  return {{{Colour(rs), ashikhmin_shirley(n_u, n_v, Fresnel::facing)},
           {Colour(1), ashikhmin_shirley(n_u, n_v, Fresnel::grazing)},
           {Colour(1 - rs), ashikhmin_shirley_diffuse()}}};
}

}  // namespace

std::optional<Brdf> parse_brdf(std::string_view text) {
  const std::size_t colon = text.find(':');
  Parser parser{text, text.substr(0, colon)};
  if (colon != text.npos) parser.read_numbers(text.substr(colon + 1));
  const auto alpha = [&](std::size_t i) { return parser.number(i, kMinAlpha, 1); };
  const auto exponent = [&](std::size_t i) { return parser.number(i, 0, kMaxExponent); };
  const std::size_t last = parser.numbers.size() - 1;
  if (parser.is("from-material", 0, 0)) return std::nullopt;
  if (parser.is("lambert", 0, 0)) return white(lambert());
  if (parser.is("phong", 1, 1)) return white(phong(parser.number(0, 1, kMaxExponent)));
  if (parser.is("ggx", 1, 2)) return white(ggx(alpha(0), alpha(last)));
  if (parser.is("ward", 1, 2)) return white(ward(alpha(0), alpha(last)));
  if (parser.is("ashikhmin-shirley", 2, 3)) {
    const double rs = last == 2 ? parser.number(2, 0, 1) : 1;
    return make_ashikhmin_shirley(exponent(0), exponent(1), rs);
  }
  reject(text);
}

}  // namespace prt::brdf
