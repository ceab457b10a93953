// How far printed parameters are from the truth, in units of the last place of the double: the text is read back as the decimal that it
// is. The command line prints a parameter as its 17 significant digits; this is the program's own printer (src/cli/number.c).
#pragma once
#include "numbers.hpp"

extern "C" {
#include "../../src/cli/number.h"
}

namespace stress {
struct Ulps {
  double most = 0;
  unsigned long long count = 0, misread = 0;
  // 10^k in quadruple precision, within a few 2^-113 of itself.
  static Wide ten(int k) {
    static const std::vector<Wide> table = [] {
      std::vector<Wide> t(1401);
      for (int i = 0; i <= 1400; i++) t[(size_t)i] = from_rational(i < 700 ? Q(1) / pow10(700 - i) : pow10(i - 700)).v;
      return t;
    }();
    return table[(size_t)(k + 700)];
  }
  bool add(double t, const Num &truth) {
    char text[CLI_NUMBER_SIZE + 1];
    text[cli_format_number(text, t)] = 0;
    count++;
    misread += strtod(text, nullptr) != t;
    uint64_t digits = 0;
    int places = 0;
    const char *p = text + (text[0] == '-');
    for (bool point = false; (*p >= '0' && *p <= '9') || *p == '.'; p++) {
      if (*p == '.') point = true;
      else digits = 10 * digits + (uint64_t)(*p - '0'), places += point;
    }
    int e = *p == 'e' ? atoi(p + 1) : 0;
    Wide read = ((Wide)(double)(digits >> 32) * 4294967296.0 + (Wide)(double)(digits & 0xffffffffu)) * ten(e - places);
    if (text[0] == '-') read = -read;
    double size = std::fabs(t), ulp = std::nextafter(size, INFINITY) - size;
    Wide off = read - truth.v;
    double ulps = std::fabs((double)(off / (Wide)ulp));
    if (ulps > most) most = ulps;
    return true;
  }
};
} // namespace stress
