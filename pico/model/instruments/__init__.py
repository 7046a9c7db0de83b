"""Instruments as data: what drivers declare, what replies mean, how numbers are converted."""
