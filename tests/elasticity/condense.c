// Static condensation by MUMPS: eliminates every unknown of a sparse symmetric positive definite
// matrix but the listed ones and hands back the dense matrix that stays (the Schur complement).
// Called from block_contact.py, which compiles it: cc -O2 -shared -fPIC -ldmumps_seq.
#include <dmumps_c.h>

// n unknowns; count entries (row, column, value) of the lower triangle; order is the place of each
// unknown in the elimination, the kept ones last; `list` names the kept. Everything counts from 1.
// dense is kept x kept, its lower triangle by rows. Returns MUMPS's error code, 0 when all went
// well; the memory used in MB goes to memory.
int condense(int n, long long count, int* rows, int* columns, double* values, int* order, int kept,
             int* list, double* dense, int* memory) {
  DMUMPS_STRUC_C m = {0};
  m.job = -1;
  m.par = 1;
  m.sym = 1;
  dmumps_c(&m);
  m.n = n;
  m.nnz = count;
  m.irn = rows;
  m.jcn = columns;
  m.a = values;
  m.perm_in = order;
  m.size_schur = kept;
  m.listvar_schur = list;
  m.schur = dense;
  for (int stream = 0; stream < 4; ++stream) m.icntl[stream] = -1;
  m.icntl[6] = 1;    // the order is given: with kept unknowns MUMPS would fall back to AMD
  m.icntl[13] = 30;  // per cent of memory beyond the estimate
  m.icntl[18] = 1;   // hand the Schur complement back
  m.job = 4;
  dmumps_c(&m);
  const int error = m.infog[0];
  *memory = m.infog[21];
  m.job = -2;
  dmumps_c(&m);
  return error;
}
