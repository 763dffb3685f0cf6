/* SPDX-License-Identifier: Apache-2.0 */
#include <dds/sockets.h>

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_tran.h>

int hc_dds_sockets(const struct ddsi_sertype* type, int sockets[HC_DDS_MOST_SOCKETS]) {
  const struct ddsi_domaingv* domain = ddsrt_atomic_ldvoidp(&type->gv);
  struct ddsi_tran_conn* const all[HC_DDS_MOST_SOCKETS] = {
      domain->disc_conn_mc, domain->data_conn_mc, domain->disc_conn_uc, domain->data_conn_uc};
  int count = 0;
  for (int i = 0; i < HC_DDS_MOST_SOCKETS; ++i)
    if (all[i] != NULL) sockets[count++] = ddsi_conn_handle(all[i]);
  return count;
}
