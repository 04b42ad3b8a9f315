// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Functions compiled twice, for the portable baseline and for AVX2; the loader picks by the
/// processor. For loops that treat elements apart (y += c x): they give the same bits either way,
/// for no sum is reordered and AVX2 alone has no fused product. Not with sanitizers, which are not
/// there yet when the loader picks.

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__AVX2__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SOFTGAUSS_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define SOFTGAUSS_VECTOR_CLONES
#endif
