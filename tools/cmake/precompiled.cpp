// The source of voqcal_precompiled, which has headers only (voqcal.cmake).
