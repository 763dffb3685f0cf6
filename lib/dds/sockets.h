/* SPDX-License-Identifier: Apache-2.0 */
#pragma once
/* The sockets of a Cyclone DDS domain. Internal. In C, as Cyclone's headers for it are not C++. */

#include <dds/ddsi/ddsi_sertype.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HC_DDS_MOST_SOCKETS 4

/* The sockets that receive for the domain of a registered type; returns their number. */
int hc_dds_sockets(const struct ddsi_sertype* type, int sockets[HC_DDS_MOST_SOCKETS]);

#ifdef __cplusplus
}
#endif
