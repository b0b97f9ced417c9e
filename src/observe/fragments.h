// fragments.h -- what bonds hold together, among the bodies of a collection.
#ifndef PLS_OBSERVE_FRAGMENTS_H
#define PLS_OBSERVE_FRAGMENTS_H

#include "observe/sums.h"

/// Only bodies of the selection are counted and weighed; they may be held together by others.
pls_status pls_measure_fragments(const pls_selection *selection, pls_fragments *out);

#endif
