/* One interface over Embree 3.13 and 4: the ray queries, whose arguments differ between the two. */
#ifndef EMBREE4_SYS_SHIM_H
#define EMBREE4_SYS_SHIM_H

#if EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#elif EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#error "EMBREE_MAJOR must be 3 or 4"
#endif

/* Nearest hit of one ray: fills ray->hit and shortens ray->ray.tfar; a miss leaves the geometry
 * ID as it was. */
void shim_intersect1(RTCScene scene, struct RTCRayHit* ray);

/* Whether anything is hit: sets tfar to -inf if so. */
void shim_occluded1(RTCScene scene, struct RTCRay* ray);

/* The same for packets; lanes whose valid mask is 0 (not -1) are left alone. `coherent` says that
 * the rays start near each other and go to about the same place. It changes speed, not answers.
 * Both pointers must have the alignment of the packet. */
void shim_occluded4(const int* valid, RTCScene scene, struct RTCRay4* rays, bool coherent);
void shim_occluded8(const int* valid, RTCScene scene, struct RTCRay8* rays, bool coherent);
void shim_occluded16(const int* valid, RTCScene scene, struct RTCRay16* rays, bool coherent);

#endif
