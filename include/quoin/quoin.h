/* quoin: an exact CSG solid modeller over capped quadric half-spaces. This header includes all others. */
#ifndef QUOIN_QUOIN_H
#define QUOIN_QUOIN_H
#include "quoin/types.h"
#include "quoin/model.h"
#include "quoin/scene.h"
#include "quoin/render.h"
#endif
