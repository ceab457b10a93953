// What a run had: models and rays counted by kind, and the largest error of the ends of each family. tools/stress adds the counts up by name.
#pragma once
#include "ulps.hpp"

#include <cstdio>
#include <map>
#include <string>

namespace stress {
struct Census {
  std::map<std::string, unsigned long long> counts; // "group.kind"
  std::map<std::string, Ulps> ends;                 // by family
  void count(const std::string &group, const std::string &kind, unsigned long long n = 1) { counts[group + "." + kind] += n; }
  // One of a few kinds by size: "1-5" and so on; upper: the last number of each kind, increasing.
  void count_size(const std::string &group, long n, std::initializer_list<long> upper) {
    long from = 1;
    for (long u : upper) {
      if (n <= u) {
        count(group, from == u ? std::to_string(u) : std::to_string(from) + "-" + std::to_string(u));
        return;
      }
      from = u + 1;
    }
    count(group, std::to_string(from) + "-");
  }
  static std::string word(std::string s) {
    for (char &c : s)
      if (c == ' ' || c == '=') c = '_';
    return s;
  }
  void print(FILE *f) const {
    for (auto &c : counts) fprintf(f, " n.%s=%llu", word(c.first).c_str(), c.second);
    for (auto &e : ends) fprintf(f, " n.ends.%s=%llu max.ulps.%s=%.6f", word(e.first).c_str(), e.second.count, word(e.first).c_str(), e.second.most);
  }
};
} // namespace stress
