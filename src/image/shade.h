/* What 64 hits send to the eye, in wide code: points, normals, Phong's terms. One body for each instruction set, the same bytes from
   all of them: every operation is one of IEEE's, in one order, and no function of the C library takes part. */
#ifndef QN_IMAGE_SHADE_H
#define QN_IMAGE_SHADE_H

#include "image/light.h"
#include "wide/packet.h"

/* The hits of a packet, by lane. Lanes that were not asked for hold anything. */
typedef struct qn_spots {
  _Alignas(64) double t[QN_LANES];
  double point[3][QN_LANES];
  double normal[3][QN_LANES];  /* unit, on the viewer's side */
  double viewer[3][QN_LANES];  /* unit, towards the viewer */
  double color[3][QN_LANES], diffuse[QN_LANES], specular[QN_LANES], shininess[QN_LANES]; /* of the material */
  double towards[3][QN_LANES], cosine[QN_LANES]; /* to the lamp in work: a unit vector, and its cosine with the normal */
  double light[3][QN_LANES];   /* the sum so far, linear */
  uint32_t surface[QN_LANES];  /* the scene's number */
  int shiny;                   /* a lane of the packet has a highlight */
} qn_spots;

typedef struct qn_shade {
  const char *name;
  /* Points, normals and viewers of `lanes`, from t and surface and the rays. */
  void (*place)(const quoin_scene *scene, const qn_packet *rays, uint64_t lanes, qn_spots *spots);
  /* towards and cosine; returns the lanes of `lanes` that the lamp is not behind (nor in). */
  uint64_t (*face)(const qn_lamp *lamp, uint64_t lanes, qn_spots *spots);
  /* The shadow rays of `lanes`, which are not none: from the points, moved outwards by QN_SHADE_POINT's bound, to the lamp. Returns the
     lanes that have one: the others are at the lamp. All lanes of out's o and d are filled in. */
  uint64_t (*shadow)(const qn_lamp *lamp, const qn_packet *rays, uint64_t lanes, const qn_spots *spots, qn_packet *out);
  /* Adds the lamp's diffuse and specular terms to the light of `lanes`. */
  void (*add)(const qn_lamp *lamp, uint64_t lanes, qn_spots *spots);
  /* All lanes' light into [0, 1]. */
  void (*clamp)(qn_spots *spots);
  /* Whether the directions of `lanes` go together well enough for a packet. */
  int (*together)(const qn_packet *rays, uint64_t lanes);
} qn_shade;

/* The body for the instruction set of this name (qn_wide.name). */
const qn_shade *qn_shade_of(const char *name);

#endif
