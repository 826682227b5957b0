"""Lines that people share: paced lines and their andon, crews, work sharing."""
