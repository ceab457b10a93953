// Random numbers that are the same everywhere (splitmix64).
#pragma once
#include <cstdint>

namespace oracle {
struct Random {
  uint64_t x;
  explicit Random(uint64_t seed) : x(seed) {}
  uint64_t next() {
    uint64_t z = (x += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  int below(int n) { return (int)(next() % (uint64_t)n); }
  int range(int lo, int hi) { return lo + below(hi - lo + 1); }
  bool chance(int percent) { return below(100) < percent; }
  double real(double lo, double hi) { return lo + (hi - lo) * (double)(next() >> 11) * 0x1p-53; }
};
} // namespace oracle
