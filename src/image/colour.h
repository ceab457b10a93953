/* Colours: sRGB as people write and files store it, linear light as it is computed. */
#ifndef QN_IMAGE_COLOUR_H
#define QN_IMAGE_COLOUR_H

/* One component of sRGB, 0 to 1, as linear light (IEC 61966-2-1). Clamped to [0, 1]; what is not a number is 0. */
double qn_srgb_to_linear(double c);
/* The inverse, clamped alike. */
double qn_srgb_from_linear(double c);

/* Rounds linear light to 8-bit sRGB: step[k] is the linear value half way, in sRGB, between levels k and k + 1; level[i] is that of
   i / QN_TONE_PARTS, and no part of the scale holds two steps. */
enum { QN_TONE_PARTS = 4096 };
typedef struct qn_tone {
  double step[256]; /* the last is infinite */
  unsigned char level[QN_TONE_PARTS + 1];
} qn_tone;
void qn_tone_make(qn_tone *tone);

/* linear: from 0 to 1, and not beyond. */
static inline unsigned char qn_tone_byte(const qn_tone *tone, double linear) {
  const unsigned low = tone->level[(int)(linear * QN_TONE_PARTS)];
  return (unsigned char)(low + (linear >= tone->step[low]));
}

#endif
