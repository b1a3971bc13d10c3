"""Figures of a run: operating point, spectra, radiation, sensors."""
