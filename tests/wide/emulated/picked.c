/* The tests named ..._8_lanes are about 8 lanes: the library that they link picks them, unasked and asked. */
#include "wide/packet.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(void) {
  unsetenv("QUOIN_ISA");
  const qn_wide *best = qn_wide_pick();
  setenv("QUOIN_ISA", "avx512", 1);
  const qn_wide *asked = qn_wide_pick();
  if (best != asked || strcmp(asked->name, "avx512") != 0 || asked->width != 8) {
    printf("picked: %s unasked, %s asked\n", best->name, asked->name);
    return 1;
  }
  return 0;
}
