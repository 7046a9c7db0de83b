"""What materials do with light by wavelength: refractive indices of glasses, responses of detectors."""
