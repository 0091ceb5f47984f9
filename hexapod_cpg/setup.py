"""Package hexapod_cpg, as colcon and ament install it."""

from setuptools import find_packages, setup

NAME = 'hexapod_cpg'

setup(
    name=NAME,
    version='0.1.0',
    description='Central pattern generator of the hexapod.',
    license='Apache-2.0',
    maintainer='Hexapod team',
    maintainer_email='team@hexapod.invalid',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
    ],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    entry_points={
        'console_scripts': [
            'cpg_node = hexapod_cpg.nodes.executables:cpg_node',
        ],
    },
)
