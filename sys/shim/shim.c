#include "shim.h"

#include <stddef.h>

/* The Rust side fills packets field by field in this order and masks with int. */
#define CHECK_PACKET(W)                                                                            \
  _Static_assert(sizeof(struct RTCRay##W) == 12 * 4 * (W), "a packet has 12 rows");                \
  _Static_assert(_Alignof(struct RTCRay##W) == 4 * (W), "a packet is aligned to a row");           \
  _Static_assert(offsetof(struct RTCRay##W, dir_x) == 4 * 4 * (W), "directions follow tnear");     \
  _Static_assert(offsetof(struct RTCRay##W, tfar) == 8 * 4 * (W), "tfar follows time")
CHECK_PACKET(4);
CHECK_PACKET(8);
CHECK_PACKET(16);
_Static_assert(sizeof(struct RTCRay) == 48, "a ray has 12 fields");
_Static_assert(sizeof(int) == 4, "a valid mask has 4 bytes a lane");
_Static_assert(RTC_INVALID_GEOMETRY_ID == 0xffffffffu, "the ID that means none");
_Static_assert(RTC_VERSION_MAJOR == EMBREE_MAJOR, "the header is of the version asked for");

#if EMBREE_MAJOR == 4

#define INIT_OCCLUDED(args, coherent)                                                              \
  struct RTCOccludedArguments args;                                                                \
  rtcInitOccludedArguments(&args);                                                                 \
  args.flags = (coherent) ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT
#define INIT_INTERSECT(args)                                                                       \
  struct RTCIntersectArguments args;                                                               \
  rtcInitIntersectArguments(&args)
#define TRACE(function, scene, rays, args) function(scene, rays, args)
#define TRACE_PACKET(function, valid, scene, rays, args) function(valid, scene, rays, args)

#else

#define INIT_OCCLUDED(args, coherent)                                                              \
  struct RTCIntersectContext args;                                                                 \
  rtcInitIntersectContext(&args);                                                                  \
  args.flags =                                                                                     \
      (coherent) ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT
#define INIT_INTERSECT(args) INIT_OCCLUDED(args, false)
#define TRACE(function, scene, rays, args) function(scene, args, rays)
#define TRACE_PACKET(function, valid, scene, rays, args) function(valid, scene, args, rays)

#endif

void shim_intersect1(RTCScene scene, struct RTCRayHit* ray) {
  INIT_INTERSECT(args);
  TRACE(rtcIntersect1, scene, ray, &args);
}

void shim_occluded1(RTCScene scene, struct RTCRay* ray) {
  INIT_OCCLUDED(args, false);
  TRACE(rtcOccluded1, scene, ray, &args);
}

void shim_occluded4(const int* valid, RTCScene scene, struct RTCRay4* rays, bool coherent) {
  INIT_OCCLUDED(args, coherent);
  TRACE_PACKET(rtcOccluded4, valid, scene, rays, &args);
}

void shim_occluded8(const int* valid, RTCScene scene, struct RTCRay8* rays, bool coherent) {
  INIT_OCCLUDED(args, coherent);
  TRACE_PACKET(rtcOccluded8, valid, scene, rays, &args);
}

void shim_occluded16(const int* valid, RTCScene scene, struct RTCRay16* rays, bool coherent) {
  INIT_OCCLUDED(args, coherent);
  TRACE_PACKET(rtcOccluded16, valid, scene, rays, &args);
}
