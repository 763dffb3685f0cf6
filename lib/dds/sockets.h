/* SPDX-License-Identifier: Apache-2.0 */
#pragma once
/* The sockets of a domain of Cyclone DDS. Internal. Its headers that say so are no C++. */

#include <dds/ddsi/ddsi_sertype.h>

#ifdef __cplusplus
extern "C" {
#endif

#define HC_DDS_MOST_SOCKETS 4

/* Those that take packets for the domain of a type that has been registered; gives their number. */
int hc_dds_sockets(const struct ddsi_sertype* type, int sockets[HC_DDS_MOST_SOCKETS]);

#ifdef __cplusplus
}
#endif
