// overlap_recall.h -- integrals over an overlap of two polyhedra by a record of its topology (overlap_record.h), of an earlier step or found now.
#ifndef PLS_CONTACT_OVERLAP_RECALL_H
#define PLS_CONTACT_OVERLAP_RECALL_H

#include "contact/near_body.h"
#include "contact/overlap_record.h"

/// Integrals about `origin`, which follows from poses and record alone, so that no answer depends on how a record was come by.
typedef struct pls_recalled
{
    pls_overlap_integrals P;
    pls_vec3 origin;
    double deep; ///< extent of the overlap along the direction in which it was looked at [m]
} pls_recalled;

/// By what an earlier step found of the faces, edges and corners about, `record` (null: nothing), or by what is found now, which is written there. False if they do not tell.
bool pls_overlap_by_record(const pls_posed *a, const pls_posed *b, const pls_slab *s, bool squares, pls_overlap_record *record,
                           pls_recalled *out);

/// The same by the record of an earlier step alone, looking along its `normal`.
bool pls_overlap_again(const pls_posed *a, const pls_posed *b, bool squares, const pls_overlap_record *record, pls_recalled *out);

#endif
