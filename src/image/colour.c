/* The sRGB transfer function (IEC 61966-2-1): c = 12.92 l for l <= 0.0031308, else 1.055 l^(1/2.4) - 0.055. */
#include "image/colour.h"

#include "image/power.h"

#include <math.h>

static double clamp01(double c) {
  return c > 0 ? (c < 1 ? c : 1) : 0; /* not a number: 0 */
}

double qn_srgb_to_linear(double c) {
  c = clamp01(c);
  return c <= 0.04045 ? c / 12.92 : qn_power((c + 0.055) / 1.055, 2.4);
}

double qn_srgb_from_linear(double c) {
  c = clamp01(c);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * qn_power(c, 1 / 2.4) - 0.055;
}

void qn_tone_make(qn_tone *tone) {
  for (int k = 0; k < 255; k++) {
    tone->step[k] = qn_srgb_to_linear((k + 0.5) / 255);
  }
  tone->step[255] = INFINITY;
  unsigned char level = 0;
  for (int i = 0; i <= QN_TONE_PARTS; i++) {
    while ((double)i / QN_TONE_PARTS >= tone->step[level]) {
      level++;
    }
    tone->level[i] = level;
  }
}
