// With RESIDUALS: how well the searches settled, counted by powers of ten of the tolerance that each is held to. A
// variant of its own, so that frames that nobody examines pay nothing.
#if RESIDUALS
layout(std430, binding = kBindResiduals) buffer Residuals { uint residuals[]; };

// `overTolerance`: what the last step still changed over what may remain.
void countResidual(int histogram, float overTolerance) {
    // The first bin is all below 1e-6, the last all that did not settle within ten times the tolerance, NaN too.
    int bin = kResidualBins - 1;
    if (overTolerance < 1e-6) bin = 0;
    else if (overTolerance < 10.0) bin = clamp(int(floor(log2(overTolerance) * 0.30103)) + 7, 1, kResidualBins - 2);
    atomicAdd(residuals[histogram * kResidualBins + bin], 1u);
}
#endif
